#include "tests/support/broken.h"

#include <functional>
#include <limits>
#include <memory>

#include "tests/support/shapes.h"

namespace lodestone::test {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct MeshFault {
  const char* name;
  std::function<void(Mesh&)> make;
  const char* what;
};

const std::vector<MeshFault>& mesh_faults() {
  static const std::vector<MeshFault> faults = {
      {"triangle names a wedge too many", [](Mesh& m) { m.triangles[3][1] = 24; }, "triangle 3 names wedge 24 of 24"},
      {"triangle names no wedge", [](Mesh& m) { m.triangles[11][2] = kNone; },
       "triangle 11 names wedge 4294967295 of 24"},
      {"wedge names a vertex too many", [](Mesh& m) { m.wedge_vertex[5] = 8; }, "wedge 5 names vertex 8 of 8"},
      {"fewer wedges than corners name", [](Mesh& m) { m.wedge_vertex.resize(20); },
       "triangle 10 names wedge 20 of 20"},
      {"more wedges than values", [](Mesh& m) { m.wedge_vertex.push_back(0); },
       "attribute NORMAL has 72 values for 25 wedges of 3"},
      {"no positions", [](Mesh& m) { m.positions.clear(); }, "wedge 0 names vertex 0 of 0"},
      {"short stream", [](Mesh& m) { std::get<std::vector<float>>(m.attributes[0].values).pop_back(); },
       "attribute NORMAL has 71 values for 24 wedges of 3"},
      {"long stream", [](Mesh& m) { std::get<std::vector<float>>(m.attributes[1].values).push_back(0); },
       "attribute TEXCOORD_0 has 49 values for 24 wedges of 2"},
      {"stream of nothing", [](Mesh& m) { m.attributes[0].components = 0; },
       "attribute NORMAL has 72 values for 24 wedges of 0"},
      {"presence of other groups", [](Mesh& m) { m.attributes[0].present = {1}; },
       "attribute NORMAL has 1 presence marks for 2 groups"},
      {"group that is not there", [](Mesh& m) { m.face_group[7] = 2; }, "triangle 7 names group 2 of 2"},
      {"fewer groups than triangles", [](Mesh& m) { m.face_group.pop_back(); },
       "there are 11 face groups for 12 triangles"},
      {"NaN position", [](Mesh& m) { m.positions[2].y = std::numeric_limits<float>::quiet_NaN(); },
       "vertex 2 of 8 has a coordinate that is not finite"},
      {"infinite position", [](Mesh& m) { m.positions[7].z = -std::numeric_limits<float>::infinity(); },
       "vertex 7 of 8 has a coordinate that is not finite"},
      {"NaN offset", [](Mesh& m) { m.offset.x = kNaN; }, "the offset is not finite"},
  };
  return faults;
}

struct ModelFault {
  const char* name;
  std::function<void(Model&)> make;
  const char* line;
};

const std::vector<ModelFault>& model_faults() {
  static const std::vector<ModelFault> faults = {
      {"material that is not there", [](Model& m) { m.meshes[0].groups[1].material = 1; },
       "mesh 0 (box): group 1 names material 1 of 1"},
      {"instance of a mesh that is not there", [](Model& m) { m.instances[0].mesh = 1; },
       "instance 0 (placed): it names mesh 1 of 1"},
      {"NaN transform", [](Model& m) { m.instances[0].transform.m[5] = kNaN; },
       "instance 0 (placed): its transform is not finite"},
      {"infinite transform", [](Model& m) { m.instances[0].transform.m[12] = kInfinity; },
       "instance 0 (placed): its transform is not finite"},
      {"far beyond what can be squared", [](Model& m) { m.instances[0].transform.m[0] = 1e200; },
       "instance 0 (placed): it may lie farther from the origin than 1e+150"},
      {"picture without bytes",
       [](Model& m) {
         m.materials[0].base_color_pixels = std::make_shared<Pixels>(Pixels{2, 2, {}});
       },
       "material 0 (paint): its picture of 2 x 2 pixels has 0 bytes"},
  };
  return faults;
}

}  // namespace

Model whole_model() {
  Mesh mesh = cube_with_seams();
  mesh.name = "box";
  mesh.groups = {{kNone, "front"}, {0, "back"}};
  mesh.face_group.assign(mesh.triangles.size(), 0);
  mesh.face_group.back() = 1;
  Model model = make_model(std::move(mesh));
  model.instances[0].name = "placed";
  model.materials.resize(1);
  model.materials[0].name = "paint";
  return model;
}

std::vector<BrokenModel> broken_models() {
  std::vector<BrokenModel> out;
  for (const MeshFault& fault : mesh_faults()) {
    Model model = whole_model();
    fault.make(model.meshes[0]);
    out.push_back({fault.name, std::move(model), std::string("mesh 0 (box): ") + fault.what, true});
  }
  for (const ModelFault& fault : model_faults()) {
    Model model = whole_model();
    fault.make(model);
    out.push_back({fault.name, std::move(model), fault.line, false});
  }
  return out;
}

PointCloud whole_cloud() {
  PointCloud cloud;
  const Mesh ball = sphere(12);
  cloud.positions = ball.positions;
  cloud.normals = ball.positions;  // of a sphere about the origin
  cloud.colors.resize(cloud.size());
  return cloud;
}

std::vector<BrokenCloud> broken_clouds() {
  const std::size_t n = whole_cloud().size();
  const auto with = [](const std::function<void(PointCloud&)>& make) {
    PointCloud cloud = whole_cloud();
    make(cloud);
    return cloud;
  };
  const auto count = [](std::size_t number, const char* text) { return std::to_string(number) + text; };
  return {
      {"NaN position", with([](PointCloud& c) { c.positions[4].x = std::numeric_limits<float>::quiet_NaN(); }),
       "points: point 4 of " + count(n, " has a coordinate that is not finite; leave it out")},
      {"infinite offset", with([](PointCloud& c) { c.offset.z = kInfinity; }), "points: the offset is not finite"},
      {"a normal short", with([](PointCloud& c) { c.normals.pop_back(); }),
       "points: there are " + count(n - 1, " normals for ") + count(n, " points")},
      {"a colour too many", with([](PointCloud& c) { c.colors.emplace_back(); }),
       "points: there are " + count(n + 1, " colours for ") + count(n, " points")},
  };
}

BitVolume whole_bits() {
  VoxelGrid grid;
  grid.size = {8, 8, 8};
  BitVolume volume(grid);
  for (std::uint32_t z = 2; z < 6; ++z) {
    for (std::uint32_t y = 2; y < 6; ++y) {
      for (std::uint32_t x = 2; x < 6; ++x) volume.set(x, y, z);
    }
  }
  return volume;
}

std::vector<BrokenBits> broken_bits() {
  const auto with = [](const std::function<void(BitVolume&)>& make) {
    BitVolume volume = whole_bits();
    make(volume);
    return volume;
  };
  return {
      {"a word short", with([](BitVolume& v) { v.words.pop_back(); })},
      {"no words", with([](BitVolume& v) { v.words.clear(); })},
      {"a larger grid", with([](BitVolume& v) { v.grid.size[2] = 9; })},
      {"rows of two words", with([](BitVolume& v) { v.row_words = 2; })},
      {"NaN origin", with([](BitVolume& v) { v.grid.origin.y = kNaN; })},
      {"flat voxels", with([](BitVolume& v) { v.grid.spacing.z = 0; })},
      {"infinite voxels", with([](BitVolume& v) { v.grid.spacing.x = kInfinity; })},
  };
}

}  // namespace lodestone::test
