"""--up: files that don't say which way is up come out upright."""
from support import Scratch

# A box of 1 x 2 x 5, 5 along z.
BOX = "".join(f"v {x} {y} {z}\n" for z in (0, 5) for y in (0, 2) for x in (0, 1)) + \
      "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"


class Axes(Scratch):
    def setUp(self):
        super().setUp()
        (self.folder / "box.obj").write_text(BOX)
        for ending in ("ply", "stl", "off"):
            self.lod("convert", "box.obj", f"box.{ending}")

    def size(self, name):
        box = self.json("info", name)["bounds"]
        return [round(b - a, 3) for a, b in zip(box["min"], box["max"])]

    def test_z_is_up_where_it_is_said(self):
        for ending in ("obj", "ply", "stl", "off"):
            self.lod("convert", f"box.{ending}", "a.glb", "--up", "z")
            self.assertEqual(self.size("a.glb"), [1, 5, 2], ending)
            self.lod("convert", f"box.{ending}", "b.glb")
            self.assertEqual(self.size("b.glb"), [1, 2, 5], ending)
            self.lod("convert", f"box.{ending}", "y.glb", "--up", "y")
            self.assertEqual((self.folder / "b.glb").read_bytes(), (self.folder / "y.glb").read_bytes())

    def test_every_verb_that_writes_knows_it(self):
        for words in (("build", "box.obj", "--ratio", "90%"), ("simplify", "box.obj", "--triangles", "12"),
                      ("remesh", "box.obj", "--resolution", "20"), ("voxelize", "box.obj", "--resolution", "20"),
                      ("boolean", "box.obj", "union", "box.ply", "--resolution", "20"),
                      ("build", "box.obj", "--method", "voxel", "--error", "5%")):
            with self.subTest(words):
                done = self.lod(*words, "-o", "a.glb", "--up", "z")
                x, y, z = self.size("a.glb")
                self.assertTrue(y > 2 * z > 2.5 * x > 0, (done.stdout, x, y, z))

    def test_coordinates_stay_in_formats_that_don_t_say(self):
        self.lod("convert", "box.obj", "a.ply", "--up", "z")
        self.assertEqual(self.size("a.ply"), [1, 2, 5])
        self.assertEqual(self.json("convert", "box.obj", "b.ply").keys(), self.json("convert", "box.obj", "b.ply", "--up", "z").keys())

    def test_a_format_with_a_rule_is_told(self):
        self.lod("convert", "box.obj", "a.glb")
        self.assert_error(self.lod("convert", "a.glb", "b.glb", "--up", "z", code=2), "a.glb", "which way is up", "leave out --up")

    def test_pictures_know_the_same_words(self):
        for name, words in (("a", ("--up", "z")), ("b", ("--up", "0,0,1")), ("c", ("--up", "y")), ("d", ())):
            self.lod("render", "box.obj", "-o", f"{name}.png", "--size", "64x48", *words)
        a, b, c, d = ((self.folder / f"{name}.png").read_bytes() for name in "abcd")
        self.assertEqual(a, b)
        self.assertEqual(c, d)
        self.assertNotEqual(a, c)
