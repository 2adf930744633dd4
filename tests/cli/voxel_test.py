"""remesh and voxelize: closed surfaces by way of voxels."""
from support import Scratch

SECONDS = {"read", "prepare", "voxelize", "resample", "isosurface", "collapse", "measure", "write", "total"}


class Voxels(Scratch):
    def test_remesh(self):
        report = self.json("remesh", "statue.ply", "-o", "r.ply", "--resolution", "40")
        self.assertEqual(set(report["seconds"]), SECONDS)
        self.assertEqual(max(report["resolution"]), 160)
        self.assertEqual(report["fill"], "parity")
        self.assertGreater(report["voxels_inside"], 0)
        shape = self.json("info", "r.ply")
        self.assertTrue(shape["closed"] and shape["manifold"])
        self.assertEqual(shape["triangles"], report["triangles"])
        self.assertLess(report["relative_error"], 0.02)
        finer = self.json("remesh", "statue.ply", "-o", "f.ply", "--resolution", "120")
        self.assertLess(finer["mean_error"], report["mean_error"])
        rough = self.json("remesh", "statue.ply", "-o", "n.ply", "--resolution", "40", "--place", "linear")
        self.assertLess(report["mean_error"], rough["mean_error"])

    def test_targets(self):
        report = self.json("remesh", "statue.ply", "-o", "r.ply", "--triangles", "6000")
        self.assertTrue(5400 <= report["triangles"] <= 6000, report["triangles"])
        report = self.json("remesh", "statue.ply", "-o", "r.ply", "--error", "1%")
        self.assertLessEqual(report["relative_error"], 0.01)
        report = self.json("remesh", "statue.ply", "-o", "r.ply", "--triangles", "600", "--then-collapse")
        self.assertEqual((report["triangles"], report["method"]), (600, "voxels and edge collapse"))
        shape = self.json("info", "r.ply")
        self.assertTrue(shape["closed"] and shape["manifold"])

    def test_ladders(self):
        for more in ((), ("--then-collapse",)):
            report = self.json("build", "statue.ply", "-o", "v.glb", "--method", "voxel", "--triangles", "4000,1000", *more)
            counts = [level["triangles"] for level in report["levels"]]
            self.assertEqual(len(counts), 3)
            self.assertLessEqual(counts[1], 4000)
            self.assertLessEqual(counts[2], 1000)
            self.assertEqual(self.json("info", "v.glb")["levels"], 3)
        self.assert_error(self.lod("build", "statue.ply", "-o", "w.glb", "--keep-thin", code=2), "--method voxel")

    def test_attributes(self):
        self.lod("sample", "terrain", "--triangles", "2000", "-o", "land.glb")
        self.json("remesh", "land.glb", "-o", "vertices.glb", "--fill", "shrinkwrap", "--resolution", "40")
        self.json("remesh", "land.glb", "-o", "textures.glb", "--fill", "shrinkwrap", "--resolution", "40",
                  "--texture-size", "128")
        names = {a["name"] for a in self.json("info", "textures.glb")["attributes"]}
        self.assertTrue({"NORMAL", "TEXCOORD_0"} <= names, names)
        self.json("remesh", "land.glb", "-o", "bare.glb", "--fill", "shrinkwrap", "--resolution", "40", "--no-attributes")
        self.assertEqual(self.json("info", "bare.glb")["attributes"], [])
        report = self.json("build", "statue.ply", "-o", "levels.glb", "--method", "voxel", "--then-collapse",
                           "--resolution", "60", "--triangles", "3000,1000", "--texture-size", "256")
        self.assertEqual(len(report["levels"]), 3)
        self.lod("build", "statue.ply", "-o", "a_LOD{level}.obj", "--method", "voxel", "--then-collapse",
                 "--resolution", "60", "--triangles", "1000", "--texture-size", "256")
        self.assertIn("a_LOD1.mtl", self.files())

    def test_boolean(self):
        self.lod("sample", "sphere", "--level", "3", "-o", "ball.ply")
        report = self.json("boolean", "ball.ply", "difference", "statue.ply", "d.ply", "--resolution", "48")
        self.assertGreater(report["voxels_inside"], 0)
        shape = self.json("info", "d.ply")
        self.assertTrue(shape["closed"] and shape["manifold"])
        self.json("boolean", "ball.ply", "union", "statue.ply", "intersection", "ball.ply", "-o", "e.ply")
        for words, part in ((("ball.ply", "xor", "statue.ply", "f.ply"), "xor"),
                            (("ball.ply", "union", "statue.ply"), "output"),
                            (("ball.ply", "union", "union", "g.ply"), "union")):
            with self.subTest(words):
                self.lod("boolean", *words, code=(1 if words[2] == "union" else 2))

    def test_voxelize(self):
        report = self.json("voxelize", "statue.ply", "-o", "c.ply", "--resolution", "30")
        self.assertEqual(set(report["seconds"]), SECONDS)
        self.assertEqual(max(report["resolution"]), 30)
        self.assertIsNone(report["relative_error"])
        shape = self.json("info", "c.ply")
        self.assertTrue(shape["closed"])
        voxel = shape["diagonal"] ** 3
        self.assertGreater(shape["volume"], 0.01 * voxel)

    def test_same_bytes_for_any_thread_count(self):
        files = []
        for threads in ("1", "2", "7"):
            self.lod("remesh", "statue.ply", "-o", "r.glb", "--resolution", "50", "--threads", threads)
            files.append((self.folder / "r.glb").read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])

    def test_what_can_not_be(self):
        flat = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" \
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n"
        (self.folder / "flat.ply").write_text(flat)
        for words, code, part in ((("statue.ply", "-o", "r.ply", "--resolution", "3"), 2, "4"),
                                  (("statue.ply", "-o", "r.ply", "--fill", "magic"), 2, "parity"),
                                  (("statue.ply", "-o", "r.xyz"), 2, "xyz"),
                                  (("statue.ply",), 2, "-o"),
                                  (("flat.ply", "-o", "r.ply"), 1, "open"),
                                  (("flat.ply", "-o", "r.ply", "--fill", "parity"), 2, "3 edges are open")):
            for verb in ("remesh", "voxelize"):
                with self.subTest((verb, words)):
                    self.assert_error(self.lod(verb, *words, code=code), part)
        self.assertEqual(self.files(), ["flat.ply", "statue.ply"])
