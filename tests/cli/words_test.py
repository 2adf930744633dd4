"""What the command says about words it can't use: names near to another, counts and commas, files that are missing or of
another kind."""
import gzip
import zipfile

from support import Scratch


class Words(Scratch):
    def refused(self, *words, code=2):
        done = self.lod(*words, code=code)
        self.assert_error(done)
        return done.stderr

    def test_names_that_are_near_or_known_elsewhere_are_suggested(self):
        for word, verb in (("biuld", "build"), ("simp", "simplify"), ("decimate", "simplify"), ("reduce", "simplify"),
                           ("optimize", "simplify"), ("lod", "build"), ("levels", "build"), ("view", "render"),
                           ("compare", "measure")):
            self.assertIn(f"did you mean {verb}?", self.refused(word, "statue.ply"))
        self.assertIn("did you mean --triangles?", self.refused("simplify", "statue.ply", "-o", "x.ply", "--faces", "9"))

    def test_what_is_near_to_nothing_is_left_at_that(self):
        for words in (("xyzzy",), ("teapot", "statue.ply"), ("info", "statue.ply", "--teapot"), ("info", "statue.ply", "-x"),
                      ("build", "statue.ply", "-o", "x.glb", "--compress", "zip"), ("sample", "teapot", "-o", "x.ply")):
            self.assertNotIn("did you mean", self.refused(*words))

    def test_values_that_are_missing_or_too_many(self):
        self.assertIn("-o needs a value: OUTPUT", self.refused("build", "statue.ply", "-o"))
        self.assertIn("--triangles needs a value: N", self.refused("simplify", "statue.ply", "--triangles"))
        self.assertIn("--output is given 2 times", self.refused("build", "statue.ply", "-o", "a.glb", "-o", "b.glb"))
        self.assertIn("--json takes no value", self.refused("info", "statue.ply", "--json=yes"))

    def test_an_output_without_its_option(self):
        for words in (("simplify", "statue.ply", "out.ply", "--ratio", "10%"), ("remesh", "statue.ply", "out.ply"),
                      ("build", "statue.ply", "out.glb"), ("render", "statue.ply", "out.png"), ("sample", "sphere", "out.ply")):
            name = next(word for word in words if word.startswith("out."))
            self.assertIn(f"to write {name}, use -o {name}", self.refused(*words))
        self.assertEqual(self.files(), ["statue.ply"])

    def test_counts_as_people_write_them(self):
        for text in ("1k", "1000", "1e3", "1,000", "0.001M"):
            self.assertEqual(self.json("simplify", "statue.ply", "-o", "x.ply", "--triangles", text)["triangles"], 1000, text)
        levels = self.json("build", "statue.ply", "-o", "x.glb", "--triangles", "2k,5e2")["levels"]
        self.assertEqual([level["triangles"] for level in levels], [4000, 2000, 500])
        for text in ("5x", "1.5", "-1", "0", "1e-3", "5,00"):
            self.refused("simplify", "statue.ply", "-o", "y.ply", "--triangles", text)
        self.assertIn("write 2000,500", self.refused("build", "statue.ply", "-o", "y.glb", "--triangles", "2,000,500"))
        self.assertEqual(self.files(), ["statue.ply", "x.glb", "x.ply"])

    def test_a_comma_that_was_meant_as_a_point(self):
        for verb in ("build", "simplify"):
            for option, text, meant in (("--error", "0,1%", "0.1%"), ("--ratio", "0,5", "0.5"), ("--ratio", "12,5%", "12.5%"),
                                        ("--error", "1,5%", "1.5%")):
                with self.subTest((verb, option, text)):
                    self.assertIn(f"write {meant} ", self.refused(verb, "statue.ply", "-o", "x.glb", option, text))
        self.assertIn("write 0.5 ", self.refused("build", "statue.ply", "-o", "x.glb", "--distances", "5,10", "--pixels", "0,5"))
        self.assertEqual(self.files(), ["statue.ply"])

    def test_a_missing_file_is_told_in_one_text_by_all_verbs(self):
        for verb in (("build", "-o", "x.glb"), ("simplify", "-o", "x.ply", "--ratio", "10%"), ("remesh", "-o", "x.ply"),
                     ("voxelize", "-o", "x.ply"), ("render", "-o", "x.png"), ("render", "--sheet", "-o", "x.png"),
                     ("render", "--level", "1", "-o", "x.png"), ("info",), ("convert", "-o", "x.glb"), ("convert", "-o", "x_{level}.obj"),
                     ("info", "--iso", "3")):
            for name in ("no.ply", "no.glb", "no.fbx", "no.las", "no.nrrd", "no"):
                with self.subTest((verb, name)):
                    self.assertEqual(self.refused(verb[0], name, *verb[1:], code=1),
                                     f"lod: {name}: no such file; is the name spelt right?\n")
        for words in (("measure", "no.ply", "statue.ply"), ("measure", "statue.ply", "no.ply"),
                      ("boolean", "statue.ply", "union", "no.ply", "x.ply"), ("build", "no.ply/", "-o", "x/")):
            self.assertIn("no such file; is the name spelt right?", self.refused(*words, code=1))

    def test_a_file_of_another_kind_is_told_as_what_it_is(self):
        statue = (self.folder / "statue.ply").read_bytes()
        with zipfile.ZipFile(self.folder / "a.zip", "w") as packed:
            packed.writestr("statue.ply", statue)
        kinds = {"ZIP archive": (self.folder / "a.zip").read_bytes(), "gzip": gzip.compress(statue),
                 "web page": b"<!DOCTYPE html>\n<html>404</html>", "PNG picture": b"\x89PNG\r\n\x1a\n" + bytes(100),
                 "git lfs pull": b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"}
        for told, content in kinds.items():
            for ending in (".glb", ".ply", ".obj", ".stl", ".fbx", ".nrrd", ".las", ".xyz"):
                with self.subTest((told, ending)):
                    name = "wrong" + ending
                    (self.folder / name).write_bytes(content)
                    self.assertIn(told, self.refused("info", name, code=1))
        self.assertIn("unpack", self.refused("build", "a.zip", "-o", "x.glb", code=1))
        (self.folder / "statue.stl").write_bytes(statue)
        self.assertIn("rename it to end in .ply", self.refused("info", "statue.stl", code=1))
