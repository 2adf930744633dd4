"""remesh and voxelize: closed surfaces by way of voxels."""
from support import Scratch

SECONDS = {"read", "prepare", "voxelize", "resample", "isosurface", "measure", "write", "total"}


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
        rough = self.json("remesh", "statue.ply", "-o", "n.ply", "--resolution", "40", "--no-project")
        self.assertLess(report["mean_error"], rough["mean_error"])

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
