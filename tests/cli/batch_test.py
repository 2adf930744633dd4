"""Several inputs at once, and names of files that are not plain."""
import json
import os
import shutil

from support import Scratch


class Batch(Scratch):
    def setUp(self):
        super().setUp()
        models = self.folder / "models"
        models.mkdir()
        shutil.copy(self.folder / "statue.ply", models / "a.ply")
        (models / "b.ply").write_text("ply\nformat ascii 1.0\nelement vertex 99\nend_header\n")
        self.lod("sample", "sphere", "--level", "3", "-o", "models/c.obj")
        (models / "notes.txt").write_text("no model\n")

    def test_goes_on_after_a_bad_file_and_says_which(self):
        done = self.lod("build", "models", "-o", "lods/", code=1)
        self.assertEqual(self.files("lods"), ["a.glb", "c.glb"])
        self.assertIn("1 of 3 failed: models/b.ply", done.stderr.splitlines()[-1])
        self.assertEqual(done.stdout.count("triangles"), 2)

    def test_json_is_one_object(self):
        runs = json.loads(self.lod("build", "models", "-o", "lods/", "--json", code=1).stdout)["runs"]
        self.assertEqual([run["input"]["path"] for run in runs], ["models/a.ply", "models/b.ply", "models/c.obj"])
        self.assertEqual(["failure" in run for run in runs], [False, True, False])
        self.assertEqual(len(runs[0]["levels"]), 5)

    def test_several_files(self):
        runs = self.json("build", "models/a.ply", "models/c.obj", "-o", "lods/", "--levels", "2")["runs"]
        self.assertEqual([run["levels"][1]["file"] for run in runs], ["lods/a.glb", "lods/c.glb"])
        self.lod("build", "models/a.ply", "models/c.obj", "-o", "{name}_LOD{level}.stl", "--levels", "2")
        self.assertTrue({"a_LOD0.stl", "a_LOD1.stl", "c_LOD0.stl", "c_LOD1.stl"} <= set(self.files()))

    def test_missed_target_is_3_when_none_failed(self):
        (self.folder / "t.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.lod("build", "models/a.ply", "t.off", "-o", "lods/", code=3)

    def test_same_stems_keep_their_endings(self):
        shutil.copy(self.folder / "models/a.ply", self.folder / "c.ply")
        self.lod("build", "c.ply", "models/c.obj", "-o", "lods/", "--levels", "2")
        self.assertEqual(self.files("lods"), ["c.obj.glb", "c.ply.glb"])

    def test_what_makes_no_sense(self):
        self.assert_error(self.lod("build", "models", "-o", "one.glb", code=2), "several inputs")
        self.assert_error(self.lod("build", "models/a.ply", "models/a.ply", "-o", "lods/", code=2), "both")
        (self.folder / "void").mkdir()
        self.assert_error(self.lod("build", "void", "-o", "lods/", code=1), "void")
        self.assert_error(self.lod("build", "models", "-o", "no/where/", code=1), "no/where")
        self.assert_error(self.lod("build", "models", "-o", "models/", code=2), "folder of the inputs")
        shutil.copy(self.folder / "models/a.ply", self.folder / "lone.glb")
        self.assert_error(self.lod("build", "lone.glb", "models/a.ply", "-o", "./", code=2), "never overwritten")
        self.assertNotIn("lods", self.files())

    def test_folder_goes_when_all_failed(self):
        self.lod("build", "models/b.ply", "missing.ply", "-o", "lods/", code=1)
        self.assertNotIn("lods", self.files())


class Names(Scratch):
    def test_spaces_and_letters_of_all_kinds(self):
        for name in ("zwei Wörter", "статуя", "像", "it's", "a;b$c"):
            with self.subTest(name):
                shutil.copy(self.folder / "statue.ply", self.folder / f"{name}.ply")
                report = self.json("build", f"{name}.ply", "-o", f"{name} lods.glb", "--levels", "2")
                self.assertEqual(report["input"]["path"], f"{name}.ply")
                self.assertTrue((self.folder / f"{name} lods.glb").exists())
                self.assertIn(name, self.lod("info", f"{name}.ply").stdout)

    def test_control_characters_are_escaped(self):
        name = "a\x1b[31m\n\u202eb.ply"
        shutil.copy(self.folder / "statue.ply", self.folder / name)
        shown = self.lod("info", name).stdout
        self.assertIn("a\\x1b[31m\\x0a\\xe2\\x80\\xaeb.ply", shown)
        self.assertNotIn("\x1b", shown)
        self.assert_error(self.lod("info", "no" + name, code=1), "noa\\x1b[31m\\x0a")
        self.assertEqual(self.json("info", name)["path"], name)

    def test_bytes_that_are_not_utf8(self):
        name = os.fsdecode(b"a\xffb.ply")
        shutil.copy(self.folder / "statue.ply", self.folder / name)
        self.assertIn("a\\xffb.ply", self.lod("info", name).stdout)
        self.assertEqual(self.json("info", name)["path"], "a\ufffdb.ply")
