"""What was told is in the file: ladders of every kind, read back level by level and measured again."""
import json

from support import Scratch, run
from volume_test import ball

# Every way of making levels.
METHODS = ((), ("--effort", "best"), ("--method", "voxel"), ("--method", "voxel", "--then-collapse"),
           ("--method", "voxel", "--texture-size", "64"))


class Readback(Scratch):
    statue_triangles = 3000

    def built(self, source, outputs, methods, *options, ratio="20%,6%"):
        for output in outputs:
            for method in methods:
                with self.subTest(output=output, method=method):
                    done = run("build", source, "-o", output, "--verify", "--samples", "20000", "--ratio", ratio, "--json",
                               *options, *method, cwd=self.folder)
                    self.assertIn(done.returncode, (0, 3), done.stderr)
                    report = json.loads(done.stdout)
                    self.assertGreaterEqual(len(report["levels"]), 2)
                    self.assertEqual(report["verified"]["levels"], len(report["levels"]) - 1)
                    self.assertLessEqual(report["verified"]["largest_difference"], 0.01)

    def test_every_method_in_one_file(self):
        self.built("statue.ply", ("o.glb", "o.gltf"), METHODS)

    def test_every_method_in_a_file_a_level(self):
        self.built("statue.ply", ("o{level}.ply", "o{level}.obj", "o{level}.glb"), METHODS)
        self.built("statue.ply", ("o{level}.stl", "o{level}.off"), ((), ("--method", "voxel")))

    def test_every_compression(self):
        for codec in ("meshopt", "draco"):
            self.built("statue.ply", ("o.glb",), METHODS[::2], "--compress", codec)

    def test_far_from_the_origin_and_in_another_unit(self):
        self.lod("convert", "statue.ply", "-o", "s.off")
        words = (self.folder / "s.off").read_text().split()
        vertices, faces = int(words[1]), int(words[2])
        head = ["ply", "format ascii 1.0", f"element vertex {vertices}"]
        head += [f"property double {axis}" for axis in "xyz"]
        head += [f"element face {faces}", "property list uchar int vertex_indices", "end_header"]
        values = [float(word) for word in words[4:4 + 3 * vertices]]
        rows = [f"{x + 5e5!r} {y + 5e6!r} {z + 100!r}" for x, y, z in zip(values[::3], values[1::3], values[2::3])]
        rest = words[4 + 3 * vertices:]
        rows += [" ".join(rest[4 * i:4 * i + 4]) for i in range(faces)]
        (self.folder / "far.ply").write_text("\n".join(head + rows) + "\n")
        self.built("far.ply", ("o.glb", "o{level}.ply"), ((), *METHODS[2:4]), "--unit", "mm")

    def test_ways_to_change_what_is_kept(self):
        self.lod("sample", "tower", "-o", "tower.glb", "--triangles", "6000")
        for ways in (("--keep-area",), ("--keep-parts",), ("--prune",), ("--join", "0.1%", "--weld", "0.01%"),
                     ("--keep-border",), ("--force",)):
            self.built("tower.glb", ("o.glb", "o{level}.ply"), ((),), *ways, ratio="50%,20%")

    def test_labels_of_a_volume(self):
        labels = bytes((1 if (v := 8 * (i % 24) // 24 + 2 * (i // 576 % 24 > 11)) < 4 else 5) for i in range(24 ** 3))
        (self.folder / "labels.raw").write_bytes(labels)
        self.built("labels.raw", ("o.glb",), METHODS[::2], "--raw", "24,24,24", "--labels", ratio="30%,10%")

    def test_instances(self):
        self.lod("sample", "tower", "-o", "tower.glb", "--triangles", "6000")
        self.built("tower.glb", ("o.glb", "o{level}.ply"), ((), ("--method", "voxel", "--keep-thin")), ratio="50%,30%")

    def test_scans(self):
        self.lod("convert", "statue.ply", "-o", "s.off")
        words = (self.folder / "s.off").read_text().split()
        points = [" ".join(words[4 + 3 * i:7 + 3 * i]) for i in range(int(words[1]))]
        (self.folder / "scan.xyz").write_text("\n".join(points) + "\n")
        self.built("scan.xyz", ("o.glb", "o{level}.obj"), METHODS[::2], ratio="30%,10%")

    def test_volumes(self):
        (self.folder / "ball.raw").write_bytes(ball(24, 8))
        self.built("ball.raw", ("o.glb", "o{level}.ply"), ((), *METHODS[2:4]), "--raw", "24,24,24", "--raw-spacing",
                   "0.5,0.5,2", "--iso", "127", ratio="30%,10%")
