"""Volumes and scans as inputs."""
import math
import struct

from support import Scratch


def ball(n, r):
    """Bytes of a ball: 255 in its middle, falling to 0."""
    middle = (n - 1) / 2
    out = bytearray()
    for z in range(n):
        for y in range(n):
            for x in range(n):
                d = math.dist((x, y, z), (middle,) * 3)
                out.append(max(0, min(255, int(127.5 + 60 * (r - d)))))
    return bytes(out)


class Volumes(Scratch):
    def setUp(self):
        super().setUp()
        (self.folder / "ball.raw").write_bytes(ball(24, 8))

    RAW = ("--raw", "24,24,24", "--raw-spacing", "0.5,0.5,2")

    def test_bare_values(self):
        report = self.json("build", "ball.raw", "-o", "ball.glb", "--iso", "127", *self.RAW, "--levels", "2")
        self.assertEqual(report["unit"], "mm")
        shape = self.json("info", "ball.raw", *self.RAW, "--iso", "127")
        self.assertTrue(shape["closed"] and shape["manifold"])
        self.assertAlmostEqual(shape["volume"], 4 / 3 * math.pi * 8 ** 3 * 0.5, delta=40)
        size = [b - a for a, b in zip(shape["bounds"]["min"], shape["bounds"]["max"])]
        self.assertAlmostEqual(size[2] / size[0], 4, delta=0.1)
        # glTF is in metres.
        metres = self.json("info", "ball.glb")["bounds"]
        self.assertAlmostEqual(metres["max"][2] - metres["min"][2], size[2] / 1000, delta=1e-6)
        self.json("remesh", "ball.raw", "-o", "even.ply", *self.RAW, "--resolution", "30", "--iso", "127")

    def test_labels(self):
        values = bytearray(12 ** 3)
        for x in range(2, 10):
            for y in range(2, 6):
                for z in range(2, 6):
                    values[(z * 12 + y) * 12 + x] = 1 if x < 6 else 5
        (self.folder / "labels.raw").write_bytes(values)
        self.lod("convert", "labels.raw", "labels.glb", "--labels", "--raw", "12,12,12")
        self.assertEqual(self.json("info", "labels.glb")["meshes"], 2)

    def test_grey_values_are_no_labels(self):
        done = self.lod("convert", "ball.raw", "b.glb", "--labels", *self.RAW, code=2)
        self.assert_error(done, "different values", "grey values", "--iso")

    def test_patients_stand_upright(self):
        """Whatever a verb makes of a CT volume, glTF's y is the patient's height."""
        head = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nspace: left-posterior-superior\nencoding: raw\n"
                "space directions: (1,0,0) (0,1,0) (0,0,2)\nspace origin: (0,0,100)\n\n")
        (self.folder / "ct.nrrd").write_bytes(head.encode() + ball(24, 8))
        for words in (("build", "--levels", "2"), ("convert",), ("voxelize", "--resolution", "20"),
                      ("remesh", "--resolution", "20")):
            with self.subTest(words):
                output = ("out.glb",) if words[0] == "convert" else ("-o", "out.glb")
                self.lod(words[0], "ct.nrrd", *output, *words[1:], "--iso", "127")
                box = self.json("info", "out.glb")["bounds"]
                size = [b - a for a, b in zip(box["min"], box["max"])]
                self.assertGreater(size[1], 1.6 * size[0])
                self.assertGreater(size[1], 1.6 * size[2])
                self.assertGreater(box["min"][1], 0.1)

    def test_what_can_not_be(self):
        for words, code, part in (((*self.RAW, "--iso", "999"), 2, "0 to 255"),
                                  (("--raw", "24,24"), 2, "three"),
                                  (("--raw", "24,24,25"), 1, "ends in slice 25"),
                                  (("--raw", "24,24,23"), 1, "more than"),
                                  ((*self.RAW, "--labels", "--iso", "3"), 2, "--labels"),
                                  ((*self.RAW, "--smooth", "2cm"), 2, "--smooth"),
                                  ((*self.RAW, "--iso", "high"), 2, "number")):
            with self.subTest(words):
                self.assert_error(self.lod("build", "ball.raw", "-o", "b.glb", *words, code=code), part)
        self.assertEqual(self.files(), ["ball.raw", "statue.ply"])

    def test_scans(self):
        points = [(math.cos(i * 2.4) * math.sqrt(1 - z * z), math.sin(i * 2.4) * math.sqrt(1 - z * z), z)
                  for i, z in ((i, 1 - (2 * i + 1) / 4000) for i in range(4000))]
        head = "ply\nformat binary_little_endian 1.0\nelement vertex 4000\n" + \
               "".join(f"property float {c}\n" for c in "xyz") + "end_header\n"
        (self.folder / "ball.ply").write_bytes(head.encode() + b"".join(struct.pack("<3f", *p) for p in points))
        shape = self.json("info", "ball.ply")
        self.assertTrue(shape["closed"] and shape["manifold"])
        self.assertAlmostEqual(shape["volume"], 4 / 3 * math.pi, delta=0.05)
        self.assertTrue(any("4,000 points" in w for w in shape["warnings"]), shape["warnings"])
        self.json("build", "ball.ply", "-o", "ball.glb", "--levels", "2", "--scan-resolution", "40")
        self.json("info", "ball.ply", "--splat")
        # A unit for what has none: as docs/volumes.md has it.
        for words in (("remesh", "-o", "c.ply", "--resolution", "20"), ("build", "-o", "c.glb", "--levels", "2"),
                      ("simplify", "-o", "c.glb", "--ratio", "10%"), ("voxelize", "-o", "c.ply", "--resolution", "12"),
                      ("convert", "-o", "c.glb"), ("info",), ("render", "-o", "c.png", "--size", "64x48")):
            with self.subTest(words):
                close = ("--close", "2cm", "--scan-resolution", "32")
                self.assert_error(self.lod(words[0], "ball.ply", *words[1:], *close, code=2), "2cm", "--unit")
                self.lod(words[0], "ball.ply", *words[1:], *close, "--unit", "dm")
        self.assert_error(self.lod("build", "ball.ply", "-o", "c.glb", "--close", "x", code=2), "--close")
