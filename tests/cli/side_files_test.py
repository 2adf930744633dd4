"""Files that come along with an output (.bin, .mtl, textures) never replace what the user still needs."""
import json

from support import Scratch

OBJ = "mtllib lib.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nusemtl red\n" \
      "f 1/1 3/1 2/1\nf 1/1 2/1 4/1\nf 2/1 3/1 4/1\nf 3/1 1/1 4/1\n"
MTL = "newmtl red\nKd 1 0 0\nmap_Kd pictures/skin.png\n"
PNG = b"\x89PNG\r\n\x1a\n"


class SideFiles(Scratch):
    def gltf(self, name, buffer):
        """A glTF whose buffer has a name of its own."""
        self.lod("convert", "statue.ply", name)
        own = (self.folder / name).with_suffix(".bin")
        own.rename(self.folder / buffer)
        document = json.loads((self.folder / name).read_text())
        document["buffers"][0]["uri"] = buffer
        (self.folder / name).write_text(json.dumps(document))

    def obj(self, picture=PNG + b"one"):
        (self.folder / "m.obj").write_text(OBJ)
        (self.folder / "lib.mtl").write_text(MTL)
        (self.folder / "pictures").mkdir(exist_ok=True)
        (self.folder / "pictures" / "skin.png").write_bytes(picture)

    def contents(self):
        return {str(path.relative_to(self.folder)): path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def assert_refused(self, named, *words):
        """Exit 1, one line that names the file and a way out, and nothing written."""
        before = self.contents()
        self.assert_error(self.lod(*words, code=1), f"lod: {named}: ", "choose another output")
        self.assertEqual(self.contents(), before)

    def test_buffer_of_the_input_stays(self):
        self.gltf("Fox.gltf", "scene.bin")
        for words in (("build", "Fox.gltf", "-o", "scene.gltf"), ("convert", "Fox.gltf", "scene.gltf"),
                      ("simplify", "Fox.gltf", "-o", "scene.gltf", "--triangles", "500")):
            self.assert_refused("scene.bin", *words)
            (self.folder / "scene.gltf").write_text("older")  # even where an earlier run could have written it
            self.assert_refused("scene.bin", *words)
            (self.folder / "scene.gltf").unlink()
        self.gltf("Fox.gltf", "s_LOD1.bin")
        self.assert_refused("s_LOD1.bin", "build", "Fox.gltf", "-o", "s_LOD{level}.gltf")
        self.gltf("Fox.gltf", "buffer.ply")
        self.assert_refused("buffer.ply", "convert", "Fox.gltf", "buffer.ply")

    def test_material_library_of_the_input_stays(self):
        self.obj()
        self.assert_refused("lib.mtl", "convert", "m.obj", "lib.obj")
        (self.folder / "lib.mtl").rename(self.folder / "m_LOD0.mtl")
        (self.folder / "m.obj").write_text(OBJ.replace("lib.mtl", "m_LOD0.mtl"))
        self.assert_refused("m_LOD0.mtl", "build", "m.obj", "-o", "m_LOD{level}.obj", "--triangles", "2")

    def test_strangers_stay(self):
        (self.folder / "firmware.bin").write_text("not ours")
        self.assert_refused("firmware.bin", "convert", "statue.ply", "firmware.gltf")
        self.obj()
        (self.folder / "other.mtl").write_text("not ours")
        self.assert_refused("other.mtl", "convert", "m.obj", "other.obj")

    def test_textures_replace_no_other_picture(self):
        self.obj()
        (self.folder / "out").mkdir()
        (self.folder / "out" / "skin.png").write_bytes(PNG + b"two")
        for output in ("out/n.obj", "out/n.ply"):
            self.assert_refused("out/skin.png", "convert", "m.obj", output)
        self.assert_refused("out/skin.png", "build", "m.obj", "-o", "out/n_LOD{level}.obj", "--triangles", "2")

    def test_the_same_texture_stays_as_it_is(self):
        self.obj()
        (self.folder / "out").mkdir()
        there = self.folder / "out" / "skin.png"
        there.write_bytes(PNG + b"one")
        before = there.stat()
        self.lod("convert", "m.obj", "out/n.obj")
        self.assertEqual(self.files("out"), ["n.mtl", "n.obj", "skin.png"])
        self.assertEqual((there.stat().st_ino, there.stat().st_mtime_ns), (before.st_ino, before.st_mtime_ns))

    def test_the_same_command_works_again(self):
        self.obj()
        for words in (("convert", "statue.ply", "a.gltf"), ("build", "statue.ply", "-o", "b.gltf", "--samples", "1000"),
                      ("convert", "m.obj", "c.obj"), ("convert", "m.obj", "c.gltf"),
                      ("build", "statue.ply", "-o", "d_LOD{level}.gltf", "--samples", "1000")):
            with self.subTest(words):
                self.lod(*words)
                first = self.contents()
                self.lod(*words)
                self.assertEqual(self.contents(), first)
        self.lod("sample", "sphere", "--level", "2", "-o", "a.gltf")  # and with other content
        self.assertEqual(self.json("info", "a.gltf")["triangles"], 320)

    def test_a_full_set_appears_or_none(self):
        self.obj()
        (self.folder / "n.mtl").mkdir()
        self.assert_refused("n.mtl", "convert", "m.obj", "n.obj")
