// From attribute streams of meshes to what each corner of the flattened scene carries.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/render/scene.h"
#include "lodestone/render/scene_detail.h"

namespace lodestone::render::detail {

/// Fills normals, uvs, colors, values and appearance from the model's streams; `data` has surface, first_drawn and
/// appearances.
/// Errors: bad_argument (as Scene::create).
Result<void> gather_corners(const Model& model, const SceneOptions& options, SceneData& data, const Task& task);

}  // namespace lodestone::render::detail
