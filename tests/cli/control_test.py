"""Where a model matters more, what stays, what may vanish."""
import random

from support import Scratch


class Control(Scratch):
    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def canopy(self, leaves=400):
        """Leaves of two triangles, none touching another."""
        source, lines, faces = random.Random(1), [], []
        for leaf in range(leaves):
            at = [source.uniform(0, 4) for _ in range(3)]
            u, v = ([source.uniform(-0.05, 0.05) for _ in range(3)] for _ in range(2))
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                lines.append("v " + " ".join(f"{at[k] + a * u[k] + b * v[k]:.6f}" for k in range(3)))
            faces += [f"f {4 * leaf + 1} {4 * leaf + 2} {4 * leaf + 3}", f"f {4 * leaf + 1} {4 * leaf + 3} {4 * leaf + 4}"]
        return self.write("canopy.obj", "\n".join(lines + faces) + "\n")

    def test_a_canopy_needs_prune_and_keep_area_keeps_its_area(self):
        self.canopy()
        area = self.json("info", "canopy.obj")["area"]
        done = self.lod("simplify", "canopy.obj", "-o", "x.ply", "--ratio", "10%", "--samples", "2000", "--keep-parts", code=3)
        self.assertIn("--prune", done.stderr)
        chosen = self.lod("simplify", "canopy.obj", "-o", "x.ply", "--ratio", "10%", "--samples", "2000")
        self.assertIn("--keep-area", chosen.stderr)
        self.lod("simplify", "canopy.obj", "-o", "y.ply", "--ratio", "10%", "--samples", "2000", "--keep-area")
        self.assertEqual((self.folder / "x.ply").read_bytes(), (self.folder / "y.ply").read_bytes())
        self.assertNotIn("--keep-area", self.lod("simplify", "statue.ply", "-o", "x.ply", "--ratio", "10%", "--samples", "2000").stderr)
        for option, least, most in (("--prune", 0, 0.3), ("--keep-area", 0.9, 1.05)):
            built = self.json("build", "canopy.obj", "-o", "l{level}.ply", "--ratio", "50%,10%", option, "--samples", "2000")
            gone = [level["vanished_parts"] for level in built["levels"]]
            self.assertEqual(gone[0], 0)
            self.assertEqual(400 - gone[2], self.json("info", "l2.ply")["components"])
            self.assertGreater(self.json("info", "l2.ply")["area"], least * area)
            self.assertLess(self.json("info", "l2.ply")["area"], most * area)
        table = self.lod("simplify", "canopy.obj", "-o", "x.ply", "--ratio", "10%", "--prune", "--samples", "2000").stdout
        self.assertIn("parts gone", table)

    def test_a_lattice_keeps_its_area(self):
        self.lod("sample", "tower", "-o", "tower.glb")
        area = self.json("info", "tower.glb")["area"]
        self.json("simplify", "tower.glb", "-o", "thin.ply", "--ratio", "15%", "--samples", "2000", "--keep-parts")
        self.json("simplify", "tower.glb", "-o", "kept.ply", "--ratio", "15%", "--keep-area", "--samples", "2000")
        self.assertLess(self.json("info", "thin.ply")["area"], 0.7 * area)
        self.assertAlmostEqual(self.json("info", "kept.ply")["area"] / area, 1, delta=0.03)

    def test_prune_does_nothing_to_a_model_of_one_part(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--ratio", "20%", "--samples", "2000")
        self.lod("simplify", "statue.ply", "-o", "b.ply", "--ratio", "20%", "--samples", "2000", "--prune")
        self.assertEqual((self.folder / "a.ply").read_bytes(), (self.folder / "b.ply").read_bytes())

    def test_the_same_bytes_for_any_number_of_threads(self):
        self.canopy()
        seen = set()
        for threads in "127":
            self.lod("simplify", "canopy.obj", "-o", "x.ply", "--ratio", "10%", "--keep-area", "--join", "0.01", "--threads",
                     threads, "--samples", "2000")
            seen.add((self.folder / "x.ply").read_bytes())
        self.assertEqual(len(seen), 1)

    def faces_of(self, name):
        """Each face of an OBJ as its corners' positions, as written."""
        points, faces = [], []
        for line in (self.folder / name).read_text().splitlines():
            words = line.split()
            if words[:1] == ["v"]:
                points.append(tuple(words[1:4]))
            elif words[:1] == ["f"]:
                faces.append(tuple(points[int(word.split("/")[0]) - 1] for word in words[1:]))
        return faces

    def test_only_the_listed_triangles_change(self):
        self.lod("convert", "statue.ply", "statue.obj")
        self.write("only.txt", "# the first half\n0-1999\n\n2000\n")
        got = self.json("simplify", "statue.obj", "-o", "x.obj", "--triangles", "2500", "--only", "only.txt")
        self.assertLessEqual(got["triangles"], 2500)
        after = set(self.faces_of("x.obj"))
        for face in self.faces_of("statue.obj")[2001:]:
            self.assertIn(face, after)

    def test_bad_lists_of_triangles(self):
        for text, code, *parts in (("0\n5-3\n", 1, "only.txt: line 2", "5-3", "range"), ("0\nx\n", 1, "line 2", "from 0"),
                                   ("1 2\n", 1, "line 1"), ("-3\n", 1, "line 1"), ("99999999999999999999\n", 1, "line 1"),
                                   ("# none\n", 1, "only.txt", "names no triangle"),
                                   ("1\n10-4000\n", 1, "only.txt: line 2", "no triangle 4000", "4,000")):
            self.write("only.txt", text)
            self.assert_error(self.lod("simplify", "statue.ply", "-o", "x.ply", "--ratio", "10%", "--only", "only.txt",
                                       code=code), *parts)
        self.assert_error(self.lod("build", "statue.ply", "-o", "x.glb", "--only", "nowhere.txt", code=1), "nowhere.txt")
        self.assertNotIn("x.ply", self.files())

    def test_spheres_that_hold_nothing_are_told(self):
        self.write("w.txt", "0 0 0 100 2\n9 9 9 1 lock\n")
        for verb, target in (("simplify", ("--ratio", "20%")), ("build", ("--ratio", "20%"))):
            words = (verb, "statue.ply", "-o", "x.glb", *target, "--weights", "w.txt", "--lock", "8,8,8,1", "--samples", "2000")
            done = self.lod(*words)
            self.assertEqual(done.stderr.count("holds no vertex"), 2, done.stderr)
            self.assertIn("w.txt: line 2", done.stderr)
            self.assertIn("--lock 8,8,8,1", done.stderr)
            self.assertEqual(len(self.json(*words)["warnings"]), 2)

    def test_joining_lets_tiles_collapse_together(self):
        tiles = []
        for i in range(16):
            x, y = i % 4 * 1.001, i // 4 * 1.001
            tiles += [f"v {x + a} {y + b} 0" for b in (0, 1) for a in (0, 1)]
        faces = [f"f {4 * i + a} {4 * i + b} {4 * i + c}" for i in range(16) for a, b, c in ((1, 2, 4), (1, 4, 3))]
        self.write("tiles.obj", "\n".join(tiles + faces) + "\n")
        done = self.lod("simplify", "tiles.obj", "-o", "x.ply", "--triangles", "4", "--samples", "2000", code=3)
        self.assertIn("--join", done.stderr)
        got = self.json("simplify", "tiles.obj", "-o", "x.ply", "--triangles", "4", "--join", "0.01", "--samples", "2000")
        self.assertLessEqual(got["error"], 0.02)
        self.assert_error(self.lod("simplify", "tiles.obj", "-o", "y.ply", "--triangles", "4", "--join", "1,2", code=2), "--join")
