"""Targets are met by measurement, and lengths mean what they say."""
import math

from support import Scratch


class Targets(Scratch):
    statue_triangles = 20000

    def test_error_holds_when_measured_again(self):
        levels = self.json("build", "statue.ply", "-o", "s_LOD{level}.ply", "--error", "0.1%,0.5%")["levels"]
        for level, limit in zip(levels[1:], (0.001, 0.005)):
            self.assertLessEqual(level["relative_error"], limit)
            again = self.json("measure", "statue.ply", f"s_LOD{level['level']}.ply", "--samples", "200000", "--seed", "9")
            self.assertLessEqual(again["relative_max"], limit * 1.02)
            self.assertGreater(again["relative_max"], limit / 2, "as coarse as the error allows")

    def test_levels_report_what_measure_finds(self):
        for level in self.json("build", "statue.ply", "-o", "s_LOD{level}.ply")["levels"][1:]:
            again = self.json("measure", "statue.ply", level["file"], "--samples", "300000", "--seed", "9")
            self.assertAlmostEqual(again["mean"] / level["mean_error"], 1, delta=0.02)
            self.assertAlmostEqual(again["rms"] / level["rms_error"], 1, delta=0.03)
            self.assertLessEqual(again["max"], level["error"] * 1.02)

    def test_pixels_are_met_from_their_distances(self):
        levels = self.json("build", "statue.ply", "-o", "x.glb", "--pixels", "1", "--distances", "2,8")["levels"]
        for level, distance in zip(levels[1:], (2, 8)):
            self.assertLessEqual(level["switch_distance"], distance * 1.000001)

    def test_triangle_counts_hold(self):
        for wanted in (10000, 777, 50):
            self.assertLessEqual(self.json("simplify", "statue.ply", "-o", "x.ply", "--triangles", str(wanted))["triangles"], wanted)

    def test_a_ratio_means_the_same_count_everywhere(self):
        for ratio in ("0.12348", "0.01999", "33.333%"):  # 2,469.6 and 399.8 of 20,000: nearer to the even count above
            built = self.json("build", "statue.ply", "-o", "x.glb", "--ratio", ratio, "--samples", "1000")["levels"][1]
            alone = self.json("simplify", "statue.ply", "-o", "x.ply", "--ratio", ratio, "--samples", "1000")
            self.assertEqual(built["triangles"], alone["triangles"], ratio)

    def test_border_is_kept_on_request(self):
        self.lod("sample", "terrain", "--triangles", "5000", "-o", "t.ply")
        before = self.json("info", "t.ply")["boundary_edges"]
        self.json("simplify", "t.ply", "-o", "free.ply", "--ratio", "20%")
        self.json("simplify", "t.ply", "-o", "kept.ply", "--ratio", "20%", "--keep-border")
        self.assertEqual(self.json("info", "kept.ply")["boundary_edges"], before)
        self.assertLess(self.json("info", "free.ply")["boundary_edges"], before)
        done = self.lod("simplify", "t.ply", "-o", "few.ply", "--triangles", "20", "--keep-border", code=3)
        self.assertIn("--keep-border", done.stderr)


class Lengths(Scratch):
    def simplified(self, *words, source="statue.ply", code=0):
        return self.json("simplify", source, "-o", "x.glb", "--samples", "20000", *words, code=code)

    def test_relative_spellings_agree_and_hold(self):
        a, b = self.simplified("--error", "0.5%"), self.simplified("--error", "0.005")
        self.assertEqual(a["triangles"], b["triangles"])
        self.assertLessEqual(a["relative_error"], 0.005)
        self.assertGreater(a["relative_error"], 0.001)

    def test_units(self):
        self.lod("convert", "statue.ply", "s.glb")  # glTF is in metres
        metres = self.simplified("--error", "3mm", source="s.glb")
        self.assertLessEqual(metres["error"], 0.003)
        self.assertEqual(metres["unit"], "m")
        told = self.simplified("--error", "3mm", "--unit", "m")
        self.assertEqual(told["triangles"], metres["triangles"])
        bare = self.simplified("--error", "0.003", "--absolute")
        self.assertEqual(bare["triangles"], metres["triangles"])
        done = self.lod("simplify", "statue.ply", "-o", "y.glb", "--error", "3mm", code=2)
        self.assert_error(done, "3mm", "--unit")
        self.assertNotIn("y.glb", self.files())

    def test_a_bare_number_that_means_much_is_doubted(self):
        for words in (("simplify", "statue.ply", "-o", "x.glb", "--samples", "5000"),
                      ("build", "statue.ply", "-o", "x.glb", "--samples", "5000"),
                      ("remesh", "statue.ply", "-o", "x.ply", "--samples", "5000", "--resolution", "16")):
            words = [*words, "--effort", "fast"] if words[0] != "remesh" else words[:-2]
            with self.subTest(words):
                done = self.lod(*words, "--error", "0.5", "--unit", "mm", code=None)
                self.assertIn("--error 0.5 allows 50 % of the diagonal; write 0.5% for a share, or 0.5mm for a length", done.stderr)
                for clear in ("50%", "0.05"):
                    self.assertNotIn("of the diagonal; write", self.lod(*words, "--error", clear, code=None).stderr)

    def test_a_unit_for_every_verb_that_asks_for_one(self):
        self.lod("convert", "statue.ply", "m.glb")
        self.lod("convert", "statue.ply", "mm.glb", "--unit", "mm")
        metres, told = (self.json("info", name)["diagonal"] for name in ("m.glb", "mm.glb"))
        self.assertAlmostEqual(told, metres / 1000, delta=1e-6 * metres)
        self.lod("measure", "statue.ply", "m.glb", "--heat", "heat.ply", "--samples", "5000")
        self.lod("render", "heat.ply", "-o", "bare.png", "--attribute", "_ERROR")
        self.lod("render", "heat.ply", "-o", "told.png", "--attribute", "_ERROR", "--unit", "cm")
        bare, told = ((self.folder / name).read_bytes() for name in ("bare.png", "told.png"))
        self.assertNotEqual(bare, told, "the legend names the unit")

    def test_error_lists(self):
        levels = self.json("build", "statue.ply", "-o", "x.glb", "--error", "0.2%,1%", "--samples", "20000")["levels"]
        self.assertEqual(len(levels), 3)
        self.assertLessEqual(levels[1]["relative_error"], 0.002)
        self.assertLessEqual(levels[2]["relative_error"], 0.01)

    def test_pixels_at_distances(self):
        levels = self.json("build", "statue.ply", "-o", "x.glb", "--pixels", "2", "--distances", "1,4", "--height", "720",
                           "--fov", "60")["levels"]
        self.assertEqual(len(levels), 3)
        for level, distance in zip(levels[1:], (1, 4)):
            allowed = 2 * 2 * distance * math.tan(math.radians(30)) / 720
            self.assertLessEqual(level["error"], allowed)
            self.assertGreater(level["error"], allowed / 4)

    def test_counts_and_ratios(self):
        levels = self.json("build", "statue.ply", "-o", "x.glb", "--triangles", "1000,200")["levels"]
        self.assertEqual([level["triangles"] for level in levels], [4000, 1000, 200])
        levels = self.json("build", "statue.ply", "-o", "x.glb", "--ratio", "25%,0.05")["levels"]
        self.assertEqual([level["triangles"] for level in levels], [4000, 1000, 200])
