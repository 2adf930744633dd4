"""glTF files that the shared data lack: valid ones with rare parts, and ones with something against the specification.

write_all(folder) writes them and returns their paths. Standard library only, the same bytes every time.
"""
import base64
import json
import math
import struct

CODES = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class Gltf:
    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [], "meshes": [],
                     "accessors": [], "bufferViews": []}
        self.data = b""

    def add(self, code, per, values, normalized=False, bounds=False, target=None):
        """An accessor of `values`, `per` an element, each padded to four bytes as vertex data must be."""
        size = struct.calcsize(code) * per
        stride = (size + 3) // 4 * 4 if target == 34962 else size
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": stride * (len(values) // per)}
        if stride != size:
            view["byteStride"] = stride
        if target:
            view["target"] = target
        for at in range(0, len(values), per):
            self.data += struct.pack(f"<{per}{code}", *values[at:at + per]).ljust(stride, b"\0")
        self.data = self.data.ljust((len(self.data) + 3) // 4 * 4, b"\0")
        self.json["bufferViews"].append(view)
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": CODES[code],
                    "count": len(values) // per, "type": KINDS[per]}
        if normalized:
            accessor["normalized"] = True
        if bounds:
            accessor["min"] = [single(min(values[k::per])) for k in range(per)]
            accessor["max"] = [single(max(values[k::per])) for k in range(per)]
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def vertices(self, code, per, values, **more):
        return self.add(code, per, values, target=34962, **more)

    def sheet(self, n=8, z=0.0, bounds=True):
        """A primitive: a wavy sheet of n x n cells."""
        points, corners = [], []
        for y in range(n + 1):
            for x in range(n + 1):
                points += [x, y, z + 0.3 * math.sin(0.9 * x) * math.cos(0.7 * y)]
        for y in range(n):
            for x in range(n):
                a = y * (n + 1) + x
                corners += [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]
        return {"attributes": {"POSITION": self.vertices("f", 3, points, bounds=bounds)},
                "indices": self.add("H", 1, corners, target=34963)}

    def skin(self, primitive, weights, joints=(0, 1, 2, 3), code="f"):
        """Weights (and joints) of each vertex as given; four to a set."""
        count = self.json["accessors"][primitive["attributes"]["POSITION"]]["count"]
        for s in range(0, len(weights), 4):
            primitive["attributes"][f"JOINTS_{s // 4}"] = self.vertices("B", 4, list(joints[s:s + 4]) * count, bounds=True)
            primitive["attributes"][f"WEIGHTS_{s // 4}"] = self.vertices(code, 4, list(weights[s:s + 4]) * count,
                                                                        normalized=code != "f", bounds=True)

    def joints(self, count):
        first = len(self.json["nodes"])
        self.json["nodes"] += [{"name": f"joint {i}"} for i in range(count)]
        self.json["nodes"][first]["children"] = list(range(first + 1, first + count))
        self.json["scenes"][0]["nodes"].append(first)
        self.json.setdefault("skins", []).append({"joints": list(range(first, first + count))})

    def draw(self, *primitives, **node):
        """A mesh and a node that draws it."""
        self.json["meshes"].append({"primitives": list(primitives)})
        self.json["nodes"].append({"mesh": len(self.json["meshes"]) - 1, **node})
        here = len(self.json["nodes"]) - 1
        if here > 0:
            self.json["scenes"][0]["nodes"].append(here)
        return here

    def animate(self, node, path, values, bounds=True, times=(0.0, 1.0)):
        per = {"rotation": 4, "weights": 1}.get(path, 3)
        samplers = self.json.setdefault("animations", [{"samplers": [], "channels": []}])[0]
        samplers["samplers"].append({"input": self.add("f", 1, list(times), bounds=bounds), "output": self.add("f", per, values)})
        samplers["channels"].append({"sampler": len(samplers["samplers"]) - 1, "target": {"node": node, "path": path}})

    def use(self, name, required=False):
        for key in ("extensionsUsed", "extensionsRequired")[:1 + required]:
            if name not in self.json.setdefault(key, []):
                self.json[key].append(name)

    def save(self, path, extra_buffers=()):
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": data_uri(self.data)}, *extra_buffers]
        path.write_text(json.dumps(self.json))
        return path


def single(value):
    return struct.unpack("<f", struct.pack("<f", value))[0] if isinstance(value, float) else value


def data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


# ---- meshopt: the plainest streams that the format allows ----

def coded_vertices(data, stride, version):
    """Deltas of all bytes as they are."""
    elements = [data[at:at + stride] for at in range(0, len(data), stride)]
    out, last = bytes([0xA0 + version]), bytes(stride)
    most = min(8192 // stride // 16 * 16, 256)
    for at in range(0, len(elements), most):
        block = elements[at:at + most]
        if version == 1:
            out += b"\xff" * (stride // 4)
        for k in range(stride):
            before, column = last[k], b""
            for element in block:
                delta = (element[k] - before) & 255
                column += bytes([(delta << 1 if delta < 128 else ~(delta << 1)) & 255])
                before = element[k]
            groups = (len(block) + 15) // 16
            if version == 0:
                out += b"\xff" * ((groups + 3) // 4) + column.ljust(16 * groups, b"\0")
            else:
                out += column
        last = block[-1]
    tail = bytes(stride) + (bytes(stride // 4) if version == 1 else b"")
    return out + tail.rjust(24 if version == 1 else 32, b"\0")


def coded_indices(values):
    out, last = b"\xd1", 0
    for value in values:
        delta = value - last
        number = (delta << 1 if delta >= 0 else ~(delta << 1)) << 1
        last = value
        while number > 127:
            out += bytes([number & 127 | 128])
            number >>= 7
        out += bytes([number])
    return out + bytes(4)


def compress(gltf, name, version, form):
    """All views under the extension `name`; `form`: whole, tagged, or bare fallback buffer."""
    plain, coded = gltf.data, b""
    for view in gltf.json["bufferViews"]:
        data = plain[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]
        if view.get("target") == 34963:
            stride, mode = 2, "INDICES"
            stream = coded_indices(struct.unpack(f"<{len(data) // 2}H", data))
        else:
            stride, mode = view.get("byteStride", 12), "ATTRIBUTES"
            stream = coded_vertices(data, stride, version)
        view["buffer"] = 1
        view["extensions"] = {name: {"buffer": 0, "byteOffset": len(coded), "byteLength": len(stream), "byteStride": stride,
                                     "mode": mode, "count": len(data) // stride}}
        coded += stream.ljust((len(stream) + 3) // 4 * 4, b"\0")
    gltf.data = coded
    gltf.use(name, form != "whole")
    stand_in = {"byteLength": len(plain)}
    if form == "whole":
        stand_in["uri"] = data_uri(plain)
    if form == "tagged":
        stand_in["extensions"] = {name: {"fallback": True}}
    return [stand_in]


# ---- the files ----

def mixed_primitives(g):
    """Primitives with different attributes, a line strip and points between them."""
    a, b = g.sheet(), g.sheet(z=2.0)
    count = 81
    a["attributes"]["NORMAL"] = g.vertices("f", 3, [0.0, 0.0, 1.0] * count)
    a["attributes"]["TEXCOORD_0"] = g.vertices("H", 2, [i * 400 for i in range(2 * count)], normalized=True)
    b["attributes"]["COLOR_0"] = g.vertices("B", 4, [200, 100, 50, 255] * count, normalized=True)
    line = {"mode": 3, "attributes": {"POSITION": g.vertices("f", 3, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0], bounds=True)}}
    points = {"mode": 0, "attributes": {"POSITION": line["attributes"]["POSITION"]}}
    g.draw(a, line, b, points)


def busy_nodes(g):
    """Meshes on a parent, an animated node, a joint, and a morphing node whose weights are animated."""
    shape = g.sheet()
    parent = g.draw(shape, children=[1], translation=[1, 0, 0])
    g.json["nodes"].append({"mesh": 0, "name": "child"})
    moving = g.draw(g.sheet(z=1.0))
    g.animate(moving, "translation", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    morphing = g.sheet(z=2.0)
    morphing["targets"] = [{"POSITION": g.vertices("f", 3, [0.0, 0.0, 0.5] * 81, bounds=True)}]
    g.animate(g.draw(morphing), "weights", [0.0, 1.0])
    assert parent == 0


def odd_transforms(g):
    """Rotations that are no unit quaternion or have a component just above one; matrices that shear, flatten, are large."""
    g.draw(g.sheet(), rotation=[0, 0, 0.5, 0.5])
    for component in (1.0003, 1.0000001, -1.0003):
        g.draw(g.sheet(z=component), rotation=[0, 0, 0, component])
    g.draw(g.sheet(z=2.0), matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1])
    g.draw(g.sheet(z=3.0), matrix=[100, 0, 0, 0, 0.005, 100, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    g.draw(g.sheet(z=4.0), matrix=[800, 600, 0, 0, -600, 800, 0, 0, 0, 0, 1000, 0, 0, 0, 0, 1])
    g.draw(g.sheet(z=1.0), matrix=[1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])


def eight_influences(g):
    shape = g.sheet()
    g.skin(shape, [32] * 7 + [31], range(8), "B")
    g.draw(shape, skin=0)
    g.joints(8)


def weights_off(g):
    """Skin weights that sum to 7/8: floats, bytes, on lines and points, on vertices of two sets."""
    for z, code in enumerate("fBH"):
        part = {"f": 0.21875, "B": 56, "H": 14336}[code]
        shape = g.sheet(z=float(z))
        g.skin(shape, [part] * 4, code=code)
        line = {"mode": 3, "attributes": {"POSITION": g.vertices("f", 3, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0], bounds=True)}}
        g.skin(line, [part] * 4, code=code)
        points = {"mode": 0, "attributes": dict(line["attributes"])}
        g.draw(shape, line, points, skin=0)
    two = g.sheet(z=5.0)
    g.skin(two, [0.109375] * 8, range(8))
    g.draw(two, skin=0)
    g.joints(8)


def weights_nearly(g):
    """A little off one, with a negative weight, with a joint named twice, with none at all."""
    for z, (weights, joints) in enumerate([([0.5, 0.4995, 0.0, 0.0], (0, 1, 0, 0)), ([1.25, -0.25, 0.0, 0.0], (0, 1, 0, 0)),
                                           ([0.5, 0.25, 0.25, 0.0], (0, 1, 1, 0)), ([0.0] * 4, (0, 0, 0, 0))]):
        shape = g.sheet(z=float(z))
        g.skin(shape, weights, joints)
        g.draw(shape, skin=0)
    g.joints(4)


def joints_out_of_range(g):
    shape = g.sheet()
    g.skin(shape, [0.5, 0.5, 0.0, 0.0], (0, 9, 0, 0))
    g.draw(shape, skin=0)
    g.joints(2)


def shared_skin(g):
    """Meshes that share joints and weights, drawn with skeletons of four and of two joints."""
    shape = g.sheet()
    g.skin(shape, [0.5, 0.25, 0.125, 0.0], (0, 3, 1, 0))
    points = {"mode": 0, "attributes": dict(shape["attributes"])}
    for skin in (1, 0, 1):
        g.draw(shape, points, skin=skin)
    g.joints(4)
    g.json["skins"].append({"joints": g.json["skins"][0]["joints"][:2]})


def quantized_uv(g):
    """Bytes whose `normalized` is spelt out as false."""
    shape = g.sheet()
    uv = g.vertices("B", 2, [5, 7] * 81)
    g.json["accessors"][uv]["normalized"] = False
    shape["attributes"]["TEXCOORD_0"] = uv
    g.draw(shape)


def no_bounds(g):
    """Positions, morph deltas and times of animations without smallest and largest values; a wrong one."""
    shape = g.sheet(bounds=False)
    shape["targets"] = [{"POSITION": g.vertices("f", 3, [0.0, 0.0, 0.5] * 81)}]
    here = g.draw(shape)
    g.animate(here, "translation", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0], bounds=False)
    g.animate(here, "weights", [0.0, 1.0], bounds=False, times=(0.25, 2.5))
    other = g.sheet(z=1.0)
    g.json["accessors"][other["attributes"]["POSITION"]]["max"][2] = 5.0
    g.draw(other)
    g.animate(1, "scale", [1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    g.json["accessors"][-2]["max"] = [3.0]


def odd_values(g):
    """Normals and tangents that are no units, colours above one; of triangles and of points, one vertex or all."""
    for z, count in enumerate((81, 1)):
        shape = g.sheet(z=float(z))
        good = 81 - count
        shape["attributes"]["NORMAL"] = g.vertices("f", 3, [0.0, 0.0, 2.0] * count + [0.0, 0.0, 1.0] * good, bounds=True)
        shape["attributes"]["TANGENT"] = g.vertices("f", 4, [0.5, 0.0, 0.0, 0.5] * count + [1.0, 0.0, 0.0, 1.0] * good, bounds=True)
        shape["attributes"]["COLOR_0"] = g.vertices("f", 3, [1.5, 0.5, -0.5] * count + [1.0, 0.5, 0.0] * good, bounds=True)
        g.draw(shape, {"mode": 0, "attributes": dict(shape["attributes"])})


def odd_attributes(g):
    """Names of one's own without underscore beside such that have it, quantized values whose extension nobody lists."""
    shape = g.sheet()
    shape["attributes"]["QUALITY"] = g.vertices("f", 1, [0.5] * 81)
    shape["attributes"]["_QUALITY"] = g.vertices("f", 1, [0.25] * 81)
    shape["targets"] = [{"POSITION": g.vertices("f", 3, [0.0, 0.0, 0.5] * 81, bounds=True), "QUALITY": g.vertices("f", 1, [0.125] * 81)}]
    shape["attributes"]["TEXCOORD_0"] = g.vertices("h", 2, [5, 7] * 81)
    shape["attributes"]["NORMAL"] = g.vertices("b", 3, [0, 0, 127] * 81, normalized=True)
    g.draw(shape)


def wrong_morph_weights(g):
    """More default weights than targets."""
    shape = g.sheet()
    shape["targets"] = [{"POSITION": g.vertices("f", 3, [0.0, 0.0, 0.5] * 81, bounds=True)}]
    g.draw(shape, weights=[0.5, 0.5])
    g.json["meshes"][0]["weights"] = [0.5, 0.5, 0.5]


CASES = [mixed_primitives, busy_nodes, odd_transforms, eight_influences, weights_off, weights_nearly, joints_out_of_range, shared_skin,
         quantized_uv, no_bounds, odd_values, odd_attributes, wrong_morph_weights]


def write_all(folder):
    paths = []
    for case in CASES:
        g = Gltf()
        case(g)
        paths.append(g.save(folder / f"{case.__name__}.gltf"))
    for name in ("EXT", "KHR"):
        for form in ("whole", "tagged", "bare"):
            for version in (0, 1)[:1 + (name == "KHR")]:
                g = Gltf()
                g.draw(g.sheet())
                extra = compress(g, f"{name}_meshopt_compression", version, form)
                paths.append(g.save(folder / f"meshopt_{name}_{form}_{version}.gltf", extra))
    return paths
