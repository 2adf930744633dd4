"""Pictures: what is written, from where, and what is refused."""
import struct
import zlib

from support import Scratch


def png(path):
    """Width, height, channels and rows of an 8-bit PNG."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert depth == 8
    channels = {2: 3, 6: 4}[kind]
    body, at = b"", 8
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        if name == b"IDAT":
            body += data[at + 8:at + 8 + size]
        at += size + 12
    raw, stride, rows, before = zlib.decompress(body), width * channels, [], bytes(width * channels)
    for y in range(height):
        start = y * (stride + 1)
        before = unfiltered(raw[start], bytearray(raw[start + 1:start + 1 + stride]), before, channels)
        rows.append(before)
    return width, height, channels, rows


def unfiltered(kind, row, above, channels):
    """One row of a PNG, its filter undone."""
    for i in range(len(row)):
        left = row[i - channels] if i >= channels else 0
        corner = above[i - channels] if i >= channels else 0
        guess = left + above[i] - corner
        paeth = min((left, above[i], corner), key=lambda x: abs(guess - x))
        row[i] = (row[i] + [0, left, above[i], (left + above[i]) // 2, paeth][kind]) & 255
    return bytes(row)


class Render(Scratch):
    def picture(self, *words, name="a.png"):
        self.lod("render", *words, "-o", name)
        return png(self.folder / name)

    def test_size_and_background(self):
        width, height, channels, rows = self.picture("statue.ply", "--size", "120x90")
        self.assertEqual((width, height, channels), (120, 90, 3))
        self.assertEqual(tuple(rows[0][:3]), (0xEC, 0xEE, 0xF1))
        self.assertNotEqual(tuple(rows[45][180:183]), (0xEC, 0xEE, 0xF1))
        clear = self.picture("statue.ply", "--size", "120x90", "--background", "none")
        self.assertEqual((clear[2], tuple(clear[3][0][:4])), (4, (0, 0, 0, 0)))
        red = self.picture("statue.ply", "--size", "120x90", "--background", "#ff0000")
        self.assertEqual(tuple(red[3][0][:3]), (255, 0, 0))

    def test_the_model_fills_the_picture(self):
        for view in ("front", "left", "top", "iso"):
            with self.subTest(view):
                width, height, _, rows = self.picture("statue.ply", "--size", "100x100", "--view", view)
                paper = rows[0][:3]
                seen = [y for y in range(height) if rows[y] != paper * width]
                columns = [x for x in range(width) if any(row[3 * x:3 * x + 3] != paper for row in rows)]
                self.assertGreater(max(seen[-1] - seen[0], columns[-1] - columns[0]), 90)
                self.assertAlmostEqual((seen[0] + seen[-1]) / 2, 49.5, delta=2)
                self.assertAlmostEqual((columns[0] + columns[-1]) / 2, 49.5, delta=2)

    def test_json(self):
        report = self.json("render", "statue.ply", "-o", "a.png", "--size", "64x48")
        promised = {"input", "level", "file", "bytes", "width", "height", "shading", "camera", "heat_range", "seconds",
                    "warnings"}
        self.assertLessEqual(promised, set(report))
        self.assertEqual((report["width"], report["height"], report["shading"]), (64, 48, "smooth"))
        self.assertEqual(report["bytes"], (self.folder / "a.png").stat().st_size)
        self.assertEqual(report["input"]["triangles"], self.statue_triangles)

    def test_look_at_is_the_named_view_told_in_numbers(self):
        first = self.json("render", "statue.ply", "-o", "a.png", "--view", "right", "--size", "100x100")
        eye = first["camera"]["eye"]
        target = [e + f for e, f in zip(eye, first["camera"]["forward"])]
        self.lod("render", "statue.ply", "-o", "b.png", "--size", "100x100", "--eye=" + ",".join(map(repr, eye)),
                 "--target=" + ",".join(map(repr, target)))
        self.assertEqual(png(self.folder / "a.png")[3], png(self.folder / "b.png")[3])
        self.lod("render", "statue.ply", "-o", "c.png", "--size", "100x100", "--angles", "90,0")
        self.assertEqual((self.folder / "a.png").read_bytes(), (self.folder / "c.png").read_bytes())

    def test_same_bytes_from_any_number_of_threads(self):
        for name in ("a.png", "a.webp"):
            written = []
            for threads in ("1", "2", "7"):
                self.lod("render", "statue.ply", "-o", name, "--size", "200x150", "--threads", threads, "--wireframe")
                written.append((self.folder / name).read_bytes())
            self.assertEqual(written[0], written[1])
            self.assertEqual(written[0], written[2])

    def test_every_shading(self):
        self.lod("sample", "terrain", "--triangles", "2000", "-o", "terrain.glb")
        pictures = set()
        for shading in ("smooth", "flat", "textured", "color", "normals", "face-normals"):
            self.lod("render", "terrain.glb", "-o", "a.png", "--size", "80x60", "--shading", shading)
            pictures.add((self.folder / "a.png").read_bytes())
        self.assertGreaterEqual(len(pictures), 5)
        report = self.json("render", "terrain.glb", "-o", "a.png", "--attribute", "TEXCOORD_0")
        self.assertEqual(report["shading"], "heat")
        self.assertAlmostEqual(report["heat_range"][1], 2 ** 0.5, 5)

    def test_webp(self):
        self.lod("render", "statue.ply", "-o", "a.webp", "--size", "80x60")
        data = (self.folder / "a.webp").read_bytes()
        self.assertEqual((data[:4], data[8:16]), (b"RIFF", b"WEBPVP8L"))

    def test_levels_of_a_ladder(self):
        self.lod("build", "statue.ply", "-o", "statue.glb", "--triangles", "1000,100")
        counts = [self.json("render", "statue.glb", "-o", "a.png", "--level", str(k))["input"]["triangles"]
                  for k in range(3)]
        self.assertEqual(counts[0], self.statue_triangles)
        self.assertLessEqual(counts[1], 1000)
        self.assertLessEqual(counts[2], 100)
        self.assert_error(self.lod("render", "statue.glb", "-o", "a.png", "--level", "3", code=2), "no level 3", "0 to 2")
        self.assert_error(self.lod("render", "statue.ply", "-o", "a.png", "--level", "1", code=2), "lod build")

    def test_bad_command_lines(self):
        cases = [
            (("-o", "a.jpg"), ".png or .webp"),
            ((), "-o statue.png"),
            (("-o", "a.png", "--size", "0x10"), "1 to 16384"),
            (("-o", "a.png", "--size", "10"), "WxH"),
            (("-o", "a.png", "--angles", "10"), "2 numbers"),
            (("-o", "a.png", "--angles", "10,95"), "-90 to 90"),
            (("-o", "a.png", "--view", "front", "--angles", "1,2"), "together"),
            (("-o", "a.png", "--target", "0,0,0"), "--eye"),
            (("-o", "a.png", "--eye", "1,1,1", "--target", "1,1,1"), "same point"),
            (("-o", "a.png", "--eye", "1,nan,1"), "3 numbers"),
            (("-o", "a.png", "--up", "0,0,0"), "no direction"),
            (("-o", "a.png", "--fov", "180"), "below 180"),
            (("-o", "a.png", "--background", "pink"), "RRGGBB"),
            (("-o", "a.png", "--shading", "heat"), "--attribute"),
            (("-o", "a.png", "--shading", "smooth", "--attribute", "x"), "--shading heat"),
            (("-o", "a.png", "--attribute", "_ERROR"), "no attribute '_ERROR'"),
            (("-o", "a.png", "--attribute", "x", "--range", "2,1"), "rise"),
        ]
        for words, part in cases:
            with self.subTest(words):
                self.assert_error(self.lod("render", "statue.ply", *words, code=2), part)
        self.assertEqual(self.files(), ["statue.ply"])

    def test_failed_runs_leave_the_old_picture(self):
        (self.folder / "a.png").write_text("precious")
        (self.folder / "bad.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
        self.lod("render", "bad.ply", "-o", "a.png", code=1)
        self.assertEqual((self.folder / "a.png").read_text(), "precious")
        self.assert_error(self.lod("render", "statue.ply", "-o", "none/a.png", code=1), "folder")

    def test_textures_of_the_input_are_never_replaced(self):
        (self.folder / "paint.png").write_bytes(self.small_png())
        (self.folder / "m.mtl").write_text("newmtl p\nmap_Kd paint.png\n")
        (self.folder / "m.obj").write_text("mtllib m.mtl\nusemtl p\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                           "f 1/1 2/2 3/3\n")
        self.assertEqual(self.json("render", "m.obj", "-o", "a.png")["shading"], "textured")
        before = (self.folder / "paint.png").read_bytes()
        done = self.lod("render", "m.obj", "-o", "paint.png", code=1)
        self.assertIn("paint.png", done.stderr)
        self.assertEqual((self.folder / "paint.png").read_bytes(), before)
        (self.folder / "paint.png").unlink()
        report = self.json("render", "m.obj", "-o", "a.png")
        self.assertTrue(any("missing" in warning and "checker" in warning for warning in report["warnings"]), report)

    def small_png(self):
        self.lod("render", "statue.ply", "-o", "small.png", "--size", "2x2")
        return (self.folder / "small.png").read_bytes()


class Sheet(Scratch):
    """render --sheet: a whole ladder in one picture."""

    def test_levels_of_a_file_and_files_of_levels(self):
        built = self.json("build", "statue.ply", "-o", "s.glb", "--levels", "3")["levels"]
        self.lod("build", "statue.ply", "-o", "s_LOD{level}.ply", "--levels", "3", "-q")
        sheet = self.json("render", "s.glb", "--sheet", "-o", "a.png", "--size", "80x60")
        self.assertEqual((sheet["width"], len(sheet["levels"])), (12 + 3 * 92, 3))
        for drawn, level in zip(sheet["levels"], built):
            self.assertEqual(drawn["triangles"], level["triangles"])
            self.assertAlmostEqual(drawn["error"], level["error"], delta=0.02 * level["error"])
            self.assertAlmostEqual(drawn["switch_distance"], level["switch_distance"], delta=0.02 * level["switch_distance"])
        self.json("render", *(f"s_LOD{i}.ply" for i in range(3)), "--sheet", "-o", "b.png", "--size", "80x60")
        turned = self.json("render", *(f"s_LOD{i}.ply" for i in (0, 2, 1)), "--sheet", "-o", "t.png", "--size", "80x60")
        for drawn, level in zip(turned["levels"], (built[0], built[2], built[1])):  # each file has its own error
            self.assertAlmostEqual(drawn["error"], level["error"], delta=0.02 * level["error"])
        again = self.json("render", "s.glb", "--sheet", "-o", "c.png", "--size", "80x60", "--threads", "1")
        self.assertEqual(again["bytes"], sheet["bytes"])
        self.assertEqual((self.folder / "a.png").read_bytes(), (self.folder / "c.png").read_bytes())
        nearer = self.json("render", "s.glb", "--sheet", "-o", "c.png", "--height", "540", "--pixels", "2")
        self.assertAlmostEqual(nearer["levels"][2]["switch_distance"], sheet["levels"][2]["switch_distance"] / 4, places=6)

    def test_what_it_refuses(self):
        self.lod("build", "statue.ply", "-o", "s.glb", "--levels", "2", "-q")
        cases = [
            (("statue.ply", "--sheet", "-o", "a.png"), "lod build"),
            (("statue.ply", "statue.ply", "-o", "a.png"), "--sheet"),
            (("statue.ply", "--height", "500", "-o", "a.png"), "--sheet"),
            (("s.glb", "--sheet", "--level", "1", "-o", "a.png"), "--level"),
            (("s.glb", "--sheet", "--eye", "1,1,1", "-o", "a.png"), "--eye"),
            (("s.glb", "--sheet", "--attribute", "x", "-o", "a.png"), "--attribute"),
            (("s.glb", "--sheet", "--size", "16000x100", "-o", "a.png"), "smaller"),
            (("s.glb", "statue.ply", "--sheet", "-o", "s.glb"), ".png or .webp"),
        ]
        for words, part in cases:
            with self.subTest(words):
                self.assert_error(self.lod("render", *words, code=2), part)
        self.assertEqual(self.files(), ["s.glb", "statue.ply"])
