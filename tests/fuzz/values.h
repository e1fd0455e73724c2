#pragma once

#include "toolkit/io/data.h"

/// Small sound values, for seeds and calls.
namespace mimetra::fuzz {

/// 3 x 3 vertices, eight triangles, texture coordinates and a group.
const TriMesh& grid();

/// Of every kind; a sequence has three frames of the grid, or one.
Data value_of(DataKind kind);
Data one_frame();

}  // namespace mimetra::fuzz
