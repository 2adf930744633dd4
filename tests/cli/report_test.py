"""build --report: a page that needs nothing else, written whole or not at all."""
from support import Scratch


class Report(Scratch):
    def test_page_and_json(self):
        built = self.json("build", "statue.ply", "-o", "s.glb", "--levels", "3", "--report", "s.html")
        self.assertEqual(built["report"], "s.html")
        page = (self.folder / "s.html").read_text()
        for part in ("statue.ply", "4,000", "--levels", "data:image/webp;base64,", "<svg", "Certified"):
            self.assertIn(part, page)
        for part in ("http:", "https:", "<script", str(self.folder)):
            self.assertNotIn(part, page)
        self.assertNotIn("report", self.json("build", "statue.ply", "-o", "t.glb", "--levels", "3"))
        self.assertEqual((self.folder / "s.glb").read_bytes(), (self.folder / "t.glb").read_bytes())

    def test_same_page_every_time(self):
        pages = []
        for threads in ("1", "3"):
            self.lod("build", "statue.ply", "-o", "s.glb", "--levels", "3", "--report", "s.html", "--threads", threads)
            pages.append((self.folder / "s.html").read_bytes())
        self.assertEqual(pages[0], pages[1])

    def test_folders_are_not_told_and_files_of_the_input_stay(self):
        self.lod("build", self.folder / "statue.ply", "-o", self.folder / "s.glb", "--levels", "2", "--report", self.folder / "s.html")
        self.assertNotIn(str(self.folder), (self.folder / "s.html").read_text())
        self.lod("convert", "statue.ply", "p.gltf")
        (self.folder / "p.bin").rename(self.folder / "page.html")
        text = (self.folder / "p.gltf").read_text().replace("p.bin", "page.html")
        (self.folder / "p.gltf").write_text(text)
        before = (self.folder / "page.html").read_bytes()
        done = self.lod("build", "p.gltf", "-o", "p.glb", "--report", "page.html", code=1)
        self.assertIn("page.html", done.stderr)
        self.assertEqual((self.folder / "page.html").read_bytes(), before)

    def test_batches(self):
        (self.folder / "models").mkdir()
        for name in ("a", "b"):
            (self.folder / "models" / f"{name}.ply").write_bytes((self.folder / "statue.ply").read_bytes())
        self.assert_error(self.lod("build", "models/", "-o", "out/", "--report", "all.html", code=2), "{name}")
        runs = self.json("build", "models/", "-o", "out/", "--levels", "2", "--report", "out/{name}.html")["runs"]
        self.assertEqual([run["report"] for run in runs], ["out/a.html", "out/b.html"])
        self.assertTrue((self.folder / "out" / "b.html").is_file())

    def test_a_missing_page_folder_is_told_before_the_work(self):
        (self.folder / "models").mkdir()
        (self.folder / "models" / "a.ply").write_bytes((self.folder / "statue.ply").read_bytes())
        done = self.lod("build", "models/", "-o", "out/", "--report", "nowhere/{name}.html", code=1)
        self.assert_error(done, "nowhere/a.html", "folder")
        self.assertEqual(self.files(), ["models", "statue.ply"])

    def test_only_defaults_that_applied_are_listed(self):
        self.lod("build", "statue.ply", "-o", "s.glb", "--triangles", "3000,2000", "--report", "s.html")
        page = (self.folder / "s.html").read_text()
        for name, there in (("--triangles", True), ("--samples", True), ("--levels", False), ("--pixels", False)):
            self.assertEqual(f">{name}<" in page, there, name)

    def test_places_that_can_not_be(self):
        for words, code, part in ((("--report", "page.txt"), 2, ".html"), (("--report", "none/page.html"), 1, "folder"),
                                  (("--report", "statue.ply"), 2, ".html")):
            with self.subTest(words):
                self.assert_error(self.lod("build", "statue.ply", "-o", "s.glb", *words, code=code), part)
        self.assertEqual(self.files(), ["statue.ply"])
        (self.folder / "page.html").mkdir()
        self.assert_error(self.lod("build", "statue.ply", "-o", "s.glb", "--report", "page.html", code=1), "directory")
