// What most programs need of the library, in one include. Every header stands on its own as well.
#pragma once

#include "lodestone/version.h"

// Results, progress and cancelling; meshes, models and ladders.
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/level.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/mesh_arrays.h"
#include "lodestone/core/model.h"
#include "lodestone/core/validate.h"

// One operation each.
#include "lodestone/measure/distance.h"
#include "lodestone/measure/screen.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/voxelize.h"

// The main job: ladders whose errors are measured, by edge collapse and by voxels.
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/chain/voxels/remesh.h"
#include "lodestone/chain/voxels/voxel_ladder.h"

// Files.
#include "lodestone/io/images/decode.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"
