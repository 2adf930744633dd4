#include "app/options/spec.h"

#include <algorithm>

#include "app/children/volume_input.h"
#include "app/options/attributes.h"
#include "app/options/axes.h"
#include "app/options/constraints.h"
#include "app/options/render_options.h"
#include "app/options/shared_options.h"
#include "app/options/surface_attributes.h"
#include "app/options/voxel_method.h"
#include "app/options/voxel_options.h"
#include "app/verbs/render_sheet.h"
#include "app/verbs/verbs.h"

namespace lodestone::app {
namespace {

constexpr std::uint64_t kBuildSamples = measure::DistanceOptions{}.samples;
constexpr std::uint64_t kMeasureSamples = 1'000'000;

InputSpec one_model() { return {"INPUT", 1, 1, {}, Completion::file}; }

VerbSpec build_spec() {
  return {
      "build",
      "Makes a ladder of levels from a model and measures each level's error against the original.",
      {"INPUT...", 1, kAnyNumber, {}, Completion::file},
      {ladder_target_group(), effort_group(), view_group(), length_group(), method_group(), level_attributes_group(),
       voxel_method_group(), volume_group(), scan_group(true), axes_group(),
       with_image_error(measuring_group(kBuildSamples)), with_report(output_group(true)), general_group()},
      {{"lod build statue.ply -o statue.glb", "five levels in one GLB (MSFT_lod), each with half the triangles"},
       {"lod build statue.ply -o statue_LOD{level}.obj --error 0.05%,0.2%,1%",
        "one file for each level, each within a measured error"},
       {"lod build models/ -o lods/ --ratio 50%,10% --json", "every model in a folder"}},
      "OUTPUT is name.glb or name.gltf (all levels in one file), name_LOD{level}.obj (any format, a file a level), or "
      "a "
      "folder with a slash at its end, where each input becomes name.glb. Several inputs, or a folder of them, need "
      "a folder; a bad file is reported and the others go on. In OUTPUT {name} stands for the input's name.",
      run_build};
}

VerbSpec simplify_spec() {
  return {"simplify",
          "Makes one coarser mesh, down to a count, a share or a measured error.",
          one_model(),
          {single_target_group(), effort_group(), length_group(), method_group(), level_attributes_group(),
           input_level_group("which level of a ladder in a glTF file is the input; 0 = its original"), volume_group(),
           scan_group(true), axes_group(), measuring_group(kBuildSamples), output_group(true), general_group()},
          {{"lod simplify statue.ply -o small.ply --triangles 5000", "at most 5,000 triangles"},
           {"lod simplify statue.ply -o small.glb --error 0.1%", "as coarse as 0.1 % of the diagonal allows"},
           {"lod simplify statue.ply -o small.obj --ratio 10% --json", "keep a tenth, figures as JSON"}},
          "",
          run_simplify};
}

VerbSpec measure_spec() {
  return {"measure",
          "Measures the distance between two surfaces, both ways; A is the original.",
          {"A B", 2, 2, {}, Completion::file},
          {with_bounded(measuring_group(kMeasureSamples)), attribute_group(), image_group(), unit_group(),
           result_group(), general_group()},
          {{"lod measure statue.ply small.ply", "how far apart they are"},
           {"lod measure statue.ply small.ply --bounded 0.01%",
            "the largest distance for certain, to within a ten-thousandth of the diagonal"},
           {"lod measure tower.glb tower.ply --attributes", "scenes as drawn; normals, UVs and colours as well"}},
          "Means and medians are over points sampled evenly by area; the largest sample is over these and all "
          "vertices. The "
          "other two maxima are the largest distance found by looking further, and a certified bound that no distance "
          "exceeds. Relative figures are divided by the diagonal of A's bounding box. --attributes compares at "
          "corresponding points: the angle between normals, the "
          "distance between UVs, between vertex colours (RGB from 0 to 1), and between the colours that a viewer shows "
          "(base colour, texture and vertex colour).",
          run_measure};
}

VerbSpec render_spec() {
  return {"render",
          "Draws a picture of a model without a display: shaded, textured, as wires, numbers as colours.",
          {"INPUT...", 1, kAnyNumber, {}, Completion::file},
          {camera_group(), look_group(), sheet_group(), unit_group(), volume_group(), scan_group(true), picture_group(),
           general_group()},
          {{"lod render statue.ply -o statue.png", "from the front and a little above, in grey"},
           {"lod render statue.glb --level 1 --wireframe --view iso -o level1.png", "a ladder's level with its edges"},
           {"lod render statue.glb --sheet -o sheet.webp", "all levels of a ladder in one picture, with their errors"}},
          "Views are named by where the eye is, for someone who stands before the model: front is +z with y up, right "
          "is +x. Faces seen from behind are drawn in a dull blue unless their material is double-sided. Numbers "
          "kept as an attribute (--shading heat --attribute NAME) are drawn with a legend.",
          run_render};
}

VerbSpec remesh_spec() {
  return {
      "remesh",
      "Makes a new closed surface of even triangles from a model, by way of voxels.",
      one_model(),
      {remesh_target_group(), solid_group(), level_group(), baked_group(), length_group(), volume_group(),
       scan_group(false), axes_group(), measuring_group(kBuildSamples), output_group(true), general_group()},
      {{"lod remesh statue.ply -o even.ply", "128 voxels along the longest side"},
       {"lod remesh statue.glb -o fine.glb --resolution 200", "a finer one"},
       {"lod remesh statue.ply -o few.ply --triangles 2000 --then-collapse",
        "closed whatever the input, and 2,000 well placed triangles"}},
      "The model is filled with voxels once, K times finer than asked. How full the larger voxels are gives a surface "
      "(Marching Cubes), whose vertices are moved onto the input. The input's normals and colours come along, at "
      "vertices or, with --texture-size, in textures.",
      run_remesh};
}

VerbSpec voxelize_spec() {
  return {"voxelize",
          "Fills a model with voxels and writes them as cubes.",
          one_model(),
          {resolution_group(), solid_group(), length_group(), volume_group(), scan_group(false), axes_group(),
           output_group(true), general_group()},
          {{"lod voxelize statue.ply -o cubes.ply --resolution 32", "32 voxels along the longest side"},
           {"lod voxelize statue.glb -o cubes.glb --resolution 64 --fill nonzero", "overlapping parts are one solid"},
           {"lod voxelize statue.ply -o cubes.obj --resolution 16 --json", "figures as JSON"}},
          "",
          run_voxelize};
}

VerbSpec boolean_spec() {
  return {"boolean",
          "Unites, intersects and subtracts models as solids of voxels.",
          {"A OPERATION B [OPERATION C]... [OUTPUT]", 3, kAnyNumber, {}, Completion::file},
          {resolution_group(), solid_group(), level_group(), length_group(), axes_group(),
           measuring_group(kBuildSamples), output_group(true), general_group()},
          {{"lod boolean sphere.glb difference statue.ply mould.ply", "the sphere without the statue: a mould"},
           {"lod boolean statue.ply union sphere.glb -o both.glb --resolution 200", "finer, as one GLB"},
           {"lod boolean sphere.glb difference statue.ply union small.ply -o out.ply --json",
            "from left to right; figures as JSON"}},
          "OPERATION is union, intersection or difference. Any number of models, combined from left to right; the last "
          "name is the output unless -o gives it. The result is closed and manifold whatever the input.",
          run_boolean};
}

VerbSpec info_spec() {
  return {"info",
          "Counts what a model has: triangles, pieces, borders, defects, attributes, materials, levels.",
          one_model(),
          {unit_group(), volume_group(), scan_group(true), result_group(), general_group()},
          {{"lod info statue.ply", "is it closed, how many pieces"},
           {"lod info tower.glb", "what a scene draws; instances count each time"},
           {"lod info statue.glb --json", "all figures as JSON"}},
          "Counts are taken after welding vertices at equal positions; the counts of the file stand beside.",
          run_info};
}

VerbSpec convert_spec() {
  return {"convert",
          "Writes a model in another format.",
          {"INPUT [OUTPUT]", 1, 2, {}, Completion::file},
          {input_level_group("write this level of a ladder in a glTF file alone; 0 = its original"), unit_group(),
           volume_group(), scan_group(true), axes_group(), output_group(true), general_group()},
          {{"lod convert statue.ply statue.stl", "by the names' endings"},
           {"lod convert tower.glb -o tower.ply", "instances are flattened where the format has none"},
           {"lod convert statue.glb -o statue_LOD{level}.obj", "each level of a ladder as a file of its own"}},
          "Without --level and {level} a ladder stays a ladder in glTF; other formats take its original.",
          run_convert};
}

VerbSpec sample_spec() {
  return {
      "sample",
      "Makes a model, volume or scan to try things on: the same file every time, on every machine.",
      {"SAMPLE", 1, 1, {"sphere", "statue", "tower", "terrain", "ct", "scan"}, Completion::choices},
      {{"Sample",
        {{"--triangles",
          "",
          "N",
          "",
          "triangles",
          "the nearest possible count (without: statue and terrain 100000, tower 20000)",
          {},
          Completion::none},
         {"--level", "", "N", "5", "subdivisions", "sphere: an icosphere of 20 * 4^N triangles", {}, Completion::none},
         {"--points", "", "N", "50000", "points", "scan: about so many", {}, Completion::none},
         {"--seed", "", "S", "1", "", "another statue, terrain, ct or scan", {}, Completion::none}}},
       output_group(false),
       general_group()},
      {{"lod sample statue -o statue.ply", "a closed bust of 100,000 triangles, rough like a scan"},
       {"lod sample sphere --level 6 -o sphere.glb", "an icosphere of 81,920 triangles"},
       {"lod sample ct -o ct.nrrd", "a knee as a CT volume, in Hounsfield units"}},
      "statue and terrain are made up of noise (--seed); terrain has open borders and texture coordinates; tower is a "
      "lattice of instanced struts and discs. ct is no mesh but a volume of 96 x 96 x 80 voxels (.nrrd; bones from 300 "
      "on, skin at -300); scan is the statue as points with normals and colours (.ply), without its underside.",
      run_sample};
}

VerbSpec help_spec() {
  return {"help",
          "Tells what a verb does and which options it takes.",
          {"[VERB]", 0, 1, {}, Completion::choices},
          {{"Output", {{"--man", "", "", "", "", "the manual page in roff instead", {}, Completion::none}}},
           general_group()},
          {{"lod help", "the verbs"},
           {"lod help build", "one verb, the same as lod build --help"},
           {"lod help --man > lod.1", "the manual page as a file"}},
          "",
          run_help};
}

VerbSpec completion_spec() {
  return {"completion",
          "Prints the completion script of a shell.",
          {"SHELL", 1, 1, {"bash", "zsh", "fish"}, Completion::choices},
          {general_group()},
          {{"lod completion bash > lod.bash", "source it, or put it into /etc/bash_completion.d"},
           {"lod completion zsh > _lod", "put it into a folder of $fpath"},
           {"lod completion fish > lod.fish", "put it into ~/.config/fish/completions"}},
          "",
          run_completion};
}

std::vector<VerbSpec> make_verbs() {
  std::vector<VerbSpec> all{build_spec(),   simplify_spec(), measure_spec(), render_spec(),
                            remesh_spec(),  voxelize_spec(), boolean_spec(), info_spec(),
                            convert_spec(), sample_spec(),   help_spec(),    completion_spec()};
  std::vector<std::string> names;
  for (const VerbSpec& verb : all) names.push_back(verb.name);
  for (VerbSpec& verb : all) {
    if (verb.name == "help") verb.inputs.choices = names;
  }
  return all;
}

}  // namespace

const std::vector<VerbSpec>& verbs() {
  static const std::vector<VerbSpec> all = make_verbs();
  return all;
}

const VerbSpec* find_verb(std::string_view name) {
  const auto& all = verbs();
  const auto found = std::find_if(all.begin(), all.end(), [&](const VerbSpec& verb) { return verb.name == name; });
  return found == all.end() ? nullptr : &*found;
}

const OptionSpec* find_option(const VerbSpec& verb, std::string_view name) {
  for (const OptionGroup& group : verb.groups) {
    for (const OptionSpec& option : group.options) {
      if (option.name == name || (!option.short_name.empty() && option.short_name == name)) return &option;
    }
  }
  return nullptr;
}

const std::vector<Example>& exit_codes() {
  static const std::vector<Example> codes{{"0", "done"},
                                          {"1", "the work failed: input, output or memory"},
                                          {"2", "wrong command line"},
                                          {"3", "written, but the asked target was not reached; the reason is told"},
                                          {"130", "interrupted; nothing half done is left"}};
  return codes;
}

}  // namespace lodestone::app
