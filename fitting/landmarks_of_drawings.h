#pragma once

#include <filesystem>

#include "fitting/face_finder.h"
#include "toolkit/correspondence/landmark_finder.h"

namespace mimetra {

/// FaceFinder as finder of landmarks in drawings of meshes: the most certain face of each. Its
/// model is read when it is used first; that throws as FaceFinder does.
LandmarkFinder landmarks_of_drawings(const std::filesystem::path& model = kDebianFaceModel);

}  // namespace mimetra
