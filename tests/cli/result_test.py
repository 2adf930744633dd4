"""Results: JSON fields that scripts rely on, the same bytes from any number of threads, samples."""
import math

from support import Scratch, run

LEVEL = {"level", "triangles", "error", "relative_error", "error_kind", "switch_distance", "bytes", "file", "seconds",
         "mean_error", "measured_error", "rms_error", "samples", "relative_mean_error", "method"}


class Json(Scratch):
    def test_build(self):
        report = self.json("build", "statue.ply", "-o", "a.glb")
        self.assertEqual(set(report), {"input", "levels", "seconds", "peak_memory_bytes", "unit", "warnings", "shortfalls"})
        self.assertEqual(set(report["input"]), {"path", "triangles", "diagonal"})
        self.assertEqual(set(report["seconds"]), {"read", "levels", "measure", "write", "total"})
        self.assertEqual([set(level) for level in report["levels"]], [LEVEL] * 5)
        self.check_levels(report["levels"], report["input"]["diagonal"])
        self.assertEqual(sum(level["bytes"] for level in report["levels"]), (self.folder / "a.glb").stat().st_size)
        self.assertGreater(report["peak_memory_bytes"], 0)

    def check_levels(self, levels, diagonal):
        self.assertEqual([level["level"] for level in levels], list(range(5)))
        self.assertEqual((levels[0]["triangles"], levels[0]["error"]), (4000, 0))
        for fine, coarse in zip(levels, levels[1:]):
            self.assertLessEqual(coarse["triangles"], fine["triangles"] / 2 + 2)
            self.assertGreaterEqual(coarse["error"], fine["error"])
            self.assertGreaterEqual(coarse["error"], coarse["measured_error"])
            self.assertAlmostEqual(coarse["relative_error"], coarse["error"] / diagonal, 12)
            self.assertEqual(coarse["error_kind"], "bounded")
            # One pixel of 1,080 lines over 45 degrees.
            distance = coarse["error"] * 1080 / (2 * math.tan(math.pi / 8))
            self.assertAlmostEqual(coarse["switch_distance"] / distance, 1, 9)

    def test_simplify(self):
        report = self.json("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500")
        promised = {"triangles_in", "triangles", "error", "relative_error", "error_kind", "stop_reason", "seconds",
                    "peak_memory_bytes"}
        self.assertLessEqual(promised, set(report))
        self.assertEqual(set(report["seconds"]), {"read", "simplify", "measure", "write"})
        self.assertEqual((report["triangles_in"], report["stop_reason"]), (4000, "reached_target"))
        self.assertLessEqual(report["triangles"], 500)
        self.assertEqual(self.json("info", "a.ply")["triangles"], report["triangles"])
        self.assertEqual(report["method"], "edge collapse")

    def test_effort(self):
        errors = {}
        for effort in ("fast", "normal", "best"):
            report = self.json("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500", "--effort", effort)
            errors[effort] = (report["measured_error"], report["mean_error"])
        self.assertLessEqual(errors["normal"][0], errors["fast"][0])
        self.assertLess(errors["best"][0], errors["fast"][0])
        self.assertLess(errors["best"][1], errors["fast"][1])
        # An error target and a ladder have normal without being asked.
        given = self.json("simplify", "statue.ply", "-o", "a.ply", "--error", "1%", "--effort", "normal")
        self.assertEqual(given["triangles"], self.json("simplify", "statue.ply", "-o", "a.ply", "--error", "1%")["triangles"])
        self.assert_error(self.lod("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500", "--effort", "all", code=2),
                          "--effort")

    def test_measure(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500")
        report = self.json("measure", "statue.ply", "a.ply", "--samples", "50000", "--seed", "3")
        promised = {"samples", "max", "mean", "rms", "relative_max", "relative_mean", "relative_rms", "forward", "backward",
                    "normal_degrees", "seconds"}
        self.assertLessEqual(promised, set(report))
        for side in ("forward", "backward"):
            self.assertLessEqual({"max", "mean", "rms"}, set(report[side]))
        self.assertEqual(report["max"], max(report["forward"]["max"], report["backward"]["max"]))
        self.assertAlmostEqual(report["mean"], (report["forward"]["mean"] + report["backward"]["mean"]) / 2, 12)
        self.assertLess(0, report["mean"])
        same = self.json("measure", "statue.ply", "statue.ply", "--samples", "1000")
        self.assertLess(same["relative_max"], 1e-7)

    def test_measure_bounds_and_shapes(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500")
        report = self.json("measure", "statue.ply", "a.ply", "--samples", "20000", "--bounded", "0.05%")
        self.assertLessEqual(report["max"], report["found_max"])
        self.assertLessEqual(report["found_max"], report["bound"])
        self.assertLessEqual(report["bound"] - report["found_max"], 0.0005 * report["diagonal"] + 1e-12)
        self.assertTrue(report["is_bounded"])
        self.assertEqual(sum(report["forward"]["histogram"]), 20000)
        self.assertLess(report["forward"]["median"], report["forward"]["percentile_95"])
        self.assertEqual((report["shape"]["a"]["genus"], report["shape"]["b"]["triangles"]), (0, 500))
        self.assert_error(self.lod("measure", "statue.ply", "a.ply", "--bounded", "0", code=2), "--bounded")

    def test_bounds_asked_for_are_never_wider_than_without(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500")
        plain = self.json("measure", "statue.ply", "a.ply", "--samples", "20000")
        for within in ("10%", "1%", "0.01%"):
            asked = self.json("measure", "statue.ply", "a.ply", "--samples", "20000", "--bounded", within)
            self.assertTrue(asked["is_bounded"])
            for way in ("forward", "backward"):
                self.assertLessEqual(asked[way]["bound"], plain[way]["bound"], (within, way))
                self.assertGreaterEqual(asked[way]["found_max"], plain[way]["found_max"], (within, way))
                self.assertEqual(asked[way]["mean"], plain[way]["mean"])

    def test_measure_pictures(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--triangles", "500")
        image = self.json("measure", "statue.ply", "a.ply", "--samples", "1000", "--image", "--views", "4")["image"]
        self.assertEqual(image["views"], 4)
        self.assertLess(0, image["silhouette_mean"])
        self.assertLess(image["shading_ssim"], 1)
        self.assertIsNone(image["color_psnr"])
        self.assert_error(self.lod("measure", "statue.ply", "a.ply", "--image", "--views", "5", code=2), "4, 6, 8, 12 or 20")

    def test_build_compares_pictures(self):
        report = self.json("build", "statue.ply", "-o", "p.glb", "--levels", "3", "--image-error")
        first, *coarser = [level["image"] for level in report["levels"]]
        self.assertEqual((first["silhouette_mean"], first["shading_psnr"], first["shading_ssim"]), (0, 100, 1))
        self.assertLess(first["silhouette_mean"], coarser[0]["silhouette_mean"])
        self.assertLess(coarser[1]["shading_psnr"], coarser[0]["shading_psnr"])
        plain = self.json("build", "statue.ply", "-o", "q.glb", "--levels", "3")
        self.assertNotIn("image", plain["levels"][1])
        self.assertEqual((self.folder / "p.glb").read_bytes(), (self.folder / "q.glb").read_bytes())

    def test_measure_heat(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--ratio", "10%", "-q")
        for name in ("heat.glb", "heat.ply"):
            heat = self.json("measure", "statue.ply", "a.ply", "--samples", "1000", "--heat", name)["heat"]
            self.assertEqual(heat["file"], name)
            self.assertTrue(0 < heat["range"] <= heat["largest"])
            shape = self.json("info", name)
            self.assertEqual(shape["triangles"], heat["triangles"])
            self.assertTrue(shape["closed"] and shape["manifold"])
            self.assertLessEqual({"_ERROR"}, {a["name"] for a in shape["attributes"]})
        self.lod("render", "heat.glb", "--attribute", "_ERROR", "-o", "heat.png", "-q")
        for name, code, word in (("heat.obj", 2, ".glb, .gltf or .ply"), ("statue.ply", 2, "input"), ("no/heat.ply", 1, "no/")):
            self.assert_error(self.lod("measure", "statue.ply", "a.ply", "--heat", name, code=code), word)

    def test_measure_attributes(self):
        self.lod("sample", "terrain", "--triangles", "4000", "-o", "terrain.glb")
        self.lod("simplify", "terrain.glb", "-o", "a.glb", "--triangles", "500")
        plain = self.json("measure", "terrain.glb", "a.glb", "--samples", "20000")
        self.assertNotIn("attributes", plain)
        found = self.json("measure", "terrain.glb", "a.glb", "--samples", "20000", "--attributes")["attributes"]
        self.assertLessEqual({"normal_degrees", "uv", "color", "look", "samples", "notes"}, set(found))
        figures = {"mean", "rms", "max", "median", "percentile_95", "share", "forward", "backward"}
        self.assertLessEqual(figures | {"set", "diagonal", "relative_mean"}, set(found["uv"][0]))
        self.assertLessEqual(figures, set(found["normal_degrees"]))
        self.assertLess(0, found["uv"][0]["mean"])
        same = self.json("measure", "terrain.glb", "terrain.glb", "--samples", "1000", "--attributes", "--uv-set", "0")
        self.assertLess(same["attributes"]["uv"][0]["max"], 1e-6)
        table = self.lod("measure", "terrain.glb", "a.glb", "--samples", "1000", "--attributes").stdout
        self.assertRegex(table, r"(?m)^UV set 0 ")

    def test_measure_attributes_that_are_not_there(self):
        self.lod("sample", "terrain", "--triangles", "500", "-o", "terrain.glb")
        with_sets = ("measure", "terrain.glb", "terrain.glb", "--samples", "100")
        self.assert_error(self.lod(*with_sets, "--uv-set", "0", code=2), "--attributes")
        self.assert_error(self.lod(*with_sets, "--attributes", "--uv-set", "3", code=2), "no UV set 3", "it has: 0")
        none = self.json("measure", "statue.ply", "statue.ply", "--samples", "100", "--attributes")["attributes"]
        self.assertEqual((none["uv"], none["color"], none["look"], none["notes"]), ([], None, None, []))

    def test_info(self):
        report = self.json("info", "statue.ply")
        promised = {"vertices", "wedges", "triangles", "components", "boundary_edges", "nonmanifold_edges", "duplicate_faces",
                    "degenerate_triangles", "closed", "diagonal", "area", "volume", "bounds", "attributes", "materials",
                    "file_vertices", "file_triangles", "nonmanifold_vertices", "meshes", "instances", "levels"}
        self.assertLessEqual(promised, set(report))
        self.assertEqual((report["vertices"], report["triangles"], report["closed"]), (2002, 4000, True))
        self.assertGreater(report["volume"], 0)

    def test_info_of_a_scene_counts_each_instance(self):
        self.lod("sample", "tower", "-o", "t.glb")
        scene = self.json("info", "t.glb")
        self.assertEqual(scene["meshes"], 3)
        self.assertGreater(scene["instances"], 300)
        self.assertEqual(scene["unit"], "m")
        self.assertEqual(scene["materials"], ["steel", "porcelain", "aluminium"])
        self.lod("convert", "t.glb", "t.ply")
        flat = self.json("info", "t.ply")
        self.assertEqual(flat["triangles"], scene["triangles"])
        self.assertAlmostEqual(flat["area"] / scene["area"], 1, 4)
        self.assertAlmostEqual(flat["diagonal"] / scene["diagonal"], 1, 5)

    def test_info_counts_levels(self):
        self.lod("build", "statue.ply", "-o", "a.glb", "--levels", "4")
        report = self.json("info", "a.glb")
        self.assertEqual((report["levels"], report["triangles"], report["meshes"]), (4, 4000, 1))

    def test_convert_and_sample(self):
        self.assertLessEqual({"input", "files", "bytes", "seconds", "warnings"}, set(self.json("convert", "statue.ply", "a.obj")))
        report = self.json("sample", "sphere", "-o", "s.ply", "--level", "2")
        self.assertEqual((report["triangles"], report["vertices"], report["file"]), (320, 162, "s.ply"))


class SameBytes(Scratch):
    statue_triangles = 30000

    def test_any_number_of_threads(self):
        self.lod("sample", "tower", "-o", "tower.glb")
        self.lod("sample", "terrain", "--triangles", "20000", "-o", "terrain.glb")
        for verb in (("build", "statue.ply", "-o", "x.glb"), ("build", "statue.ply", "-o", "x.glb", "--error", "0.1%,1%"),
                     ("build", "tower.glb", "-o", "x.glb"), ("build", "terrain.glb", "-o", "x.glb", "--compress", "meshopt"),
                     ("simplify", "statue.ply", "-o", "x.glb", "--ratio", "3%"), ("convert", "statue.ply", "x.glb")):
            with self.subTest(verb):
                seen = set()
                few = () if verb[0] == "convert" else ("--samples", "20000")
                for threads in ("1", "2", "7", "2"):
                    self.assertIn(run(*verb, "--threads", threads, *few, cwd=self.folder).returncode, (0, 3))
                    seen.add((self.folder / "x.glb").read_bytes())
                self.assertEqual(len(seen), 1)

    def test_samples_too(self):
        for name in ("statue", "terrain", "sphere", "tower"):
            seen = set()
            for threads in ("1", "7"):
                self.lod("sample", name, "--triangles", "30000", "-o", "x.glb", "--threads", threads)
                seen.add((self.folder / "x.glb").read_bytes())
            self.assertEqual(len(seen), 1, name)

    def test_measure_says_the_same(self):
        self.lod("simplify", "statue.ply", "-o", "a.ply", "--ratio", "10%")
        figures = [self.json("measure", "statue.ply", "a.ply", "--samples", "50000", "--threads", n) for n in ("1", "2", "7")]
        for one in figures:
            del one["seconds"]
        self.assertEqual(figures[0], figures[1])
        self.assertEqual(figures[0], figures[2])


class Samples(Scratch):
    def info(self, *words):
        self.lod("sample", *words, "-o", "s.ply")
        return self.json("info", "s.ply")

    def test_closed_at_any_count(self):
        for name in ("statue", "sphere"):
            for wanted in (1, 6, 8, 50, 999, 1000, 12346):
                with self.subTest((name, wanted)):
                    info = self.info(name, "--triangles", str(wanted))
                    self.assertTrue(info["closed"] and info["manifold"])
                    self.assertEqual(info["components"], 1)
                    self.assertEqual(info["triangles"], max(6, wanted + wanted % 2))
                    self.assertEqual(info["vertices"] * 2 - 4, info["triangles"], "genus 0")

    def test_sphere_levels(self):
        for level in range(4):
            self.assertEqual(self.info("sphere", "--level", str(level))["triangles"], 20 * 4**level)

    def test_terrain_is_open_and_has_texture_coordinates(self):
        info = self.info("terrain", "--triangles", "2000")
        self.assertFalse(info["closed"])
        self.assertEqual((info["triangles"], info["components"]), (2000, 1))
        self.lod("sample", "terrain", "--triangles", "2000", "-o", "s.glb")
        self.assertEqual([a["semantic"] for a in self.json("info", "s.glb")["attributes"]], ["uv"])

    def test_tower_comes_near_the_count(self):
        for wanted in (20000, 50000, 300000):
            self.lod("sample", "tower", "--triangles", str(wanted), "-o", "t.glb")
            self.assertLess(abs(self.json("info", "t.glb")["triangles"] / wanted - 1), 0.01)

    def test_ct_is_a_knee_in_hounsfield_units(self):
        self.lod("sample", "ct", "-o", "ct.nrrd")
        bones = self.json("info", "ct.nrrd", "--iso", "300")
        self.assertGreaterEqual(bones["components"], 4)
        skin = self.json("info", "ct.nrrd", "--iso", "-300")
        self.assertLess(3 * bones["volume"], skin["volume"])
        self.lod("convert", "ct.nrrd", "ct.glb", "--iso", "-300")
        box = self.json("info", "ct.glb")["bounds"]
        self.assertAlmostEqual(box["max"][1] - box["min"][1], 0.12, delta=0.005)  # the leg stands, in metres

    def test_scan_is_points_with_normals_and_colours(self):
        made = self.json("sample", "scan", "--points", "5k", "-o", "scan.ply")
        self.assertLess(abs(made["points"] / 5000 - 1), 0.1)
        head = (self.folder / "scan.ply").read_bytes()[:600]
        for word in (b"property float nx", b"property uchar red", b"end_header"):
            self.assertIn(word, head)
        info = self.json("info", "scan.ply")
        self.assertAlmostEqual(info["bounds"]["max"][1] - info["bounds"]["min"][1], 0.68, delta=0.03)

    def test_samples_that_are_no_meshes_refuse_what_they_have_not(self):
        for words, part in ((("ct", "-o", "ct.ply"), ".nrrd"), (("scan", "-o", "scan.glb"), ".ply"), (("ct",), "ct.nrrd"),
                            (("ct", "-o", "ct.nrrd", "--triangles", "9"), "--triangles"), (("scan", "-o", "s.ply", "--level", "2"), "--level"),
                            (("statue", "-o", "s.ply", "--points", "9"), "--points")):
            self.assert_error(self.lod("sample", *words, code=2), part)

    def test_seed_and_repetition(self):
        def made(*words):
            self.lod("sample", "statue", "--triangles", "500", "-o", "s.ply", *words)
            return (self.folder / "s.ply").read_bytes()
        self.assertEqual(made(), made("--seed", "1"))
        self.assertNotEqual(made(), made("--seed", "2"))
