"""Levels of a ladder in one file, taken out of it again."""
import json
import struct

from support import Scratch


class LadderLevels(Scratch):
    def setUp(self):
        super().setUp()
        self.levels = self.json("build", "statue.ply", "-o", "s.glb", "--ratio", "50%,10%", "--samples", "5000")["levels"]

    def document(self, name):
        data = (self.folder / name).read_bytes()
        return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])

    def test_each_becomes_a_file(self):
        for kind in ("obj", "glb", "ply"):
            with self.subTest(kind):
                report = self.json("convert", "s.glb", "-o", f"s_LOD{{level}}.{kind}")
                self.assertEqual(report["files"], [f"s_LOD{k}.{kind}" for k in range(3)])
                self.assertEqual(report["file_triangles"], [level["triangles"] for level in self.levels])
                for k in range(1, 3):
                    measured = self.json("measure", "statue.ply", f"s_LOD{k}.{kind}", "--samples", "5000")
                    self.assertAlmostEqual(measured["bound"], self.levels[k]["measured_error"], delta=1e-3 * measured["bound"])
                self.assertEqual(self.json("info", f"s_LOD1.{kind}")["levels"], 1)
        self.assertNotIn("s_LOD{level}.obj", self.files())

    def test_one_is_taken(self):
        for k in range(3):
            self.json("convert", "s.glb", "-o", "one.glb", "--level", str(k))
            shape = self.json("info", "one.glb")
            self.assertEqual((shape["triangles"], shape["levels"]), (self.levels[k]["triangles"], 1))
            document = self.document("one.glb")
            self.assertNotIn("MSFT_lod", json.dumps(document))
            self.assertEqual(len(document["nodes"]), 1)
        self.assertLess((self.folder / "one.glb").stat().st_size, (self.folder / "s.glb").stat().st_size / 8,
                        "nothing of the other levels is carried along")

    def test_one_is_simplified(self):
        for output in ("small.glb", "small.ply"):
            report = self.json("simplify", "s.glb", "-o", output, "--level", "1", "--triangles", "500", "--samples", "5000")
            self.assertEqual(report["triangles_in"], 2000)
            self.assertLessEqual(self.json("info", output)["triangles"], 500)

    def test_materials_and_instances_stay(self):
        self.lod("sample", "tower", "--triangles", "4000", "-o", "tower.glb")
        levels = self.json("build", "tower.glb", "-o", "t.glb", "--ratio", "50%", "--samples", "5000")["levels"]
        self.lod("convert", "t.glb", "-o", "t1.glb", "--level", "1")
        before, after = self.json("info", "t.glb"), self.json("info", "t1.glb")
        self.assertEqual(after["triangles"], levels[1]["triangles"])
        for key in ("instances", "materials"):
            self.assertEqual(after[key], before[key])

    def test_what_has_no_meaning_is_refused(self):
        for words, part in ((("convert", "statue.ply", "-o", "x_LOD{level}.obj"), "lod build"),
                            (("convert", "s.glb", "-o", "x_LOD{level}.obj", "--level", "1"), "--level"),
                            (("convert", "s.glb", "-o", "x.obj", "--level", "3"), "0 to 2"),
                            (("convert", "statue.ply", "x.obj", "--level", "1"), "lod build"),
                            (("simplify", "s.glb", "-o", "x_LOD{level}.obj", "--ratio", "10%"), "lod build"),
                            (("simplify", "s.glb", "-o", "x.obj", "--level", "7", "--ratio", "10%"), "0 to 2"),
                            (("remesh", "statue.ply", "-o", "x{level}.ply"), "{level}")):
            with self.subTest(words):
                self.assert_error(self.lod(*words, code=2), part)
        self.assertEqual(self.files(), ["s.glb", "statue.ply"])
