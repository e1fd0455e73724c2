#pragma once

#include <string>
#include <vector>

#include "toolkit/io/usd_path.h"
#include "toolkit/mesh/tri_mesh.h"

/// Where skeletons of USD hold meshes at rest. Internal to the format.
///
/// [UsdSkelSkeleton, UsdSkelBindingAPI]
namespace mimetra {

/// A matrix4d of USD. Throws IoError with the line where it is not 16 numbers for each matrix.
Eigen::Matrix4d usd_first_matrix(const std::string& path, const UsdProperty& property);

/// A mesh as a whole on the joints that its vertices hang on.
struct UsdHold {
  /// From the mesh's own coordinates to where the first of its joints holds it at rest, in those of
  /// the skeleton.
  Eigen::Matrix4d bound = Eigen::Matrix4d::Identity();
  std::string joint = {};  ///< that one; empty where the skeleton names none
  /// Other joints of the mesh that would hold it elsewhere, by more than rounding.
  std::vector<std::string> elsewhere = {};
};

/// How `skeleton` holds the mesh of `stack` with `points` (N x 3). Throws IoError with the line of
/// matrices that are none or have no inverse, and of joints that the skeleton does not have.
UsdHold usd_hold(const std::string& path, const UsdPrim& skeleton, const UsdStack& stack,
                 const Positions& points);

}  // namespace mimetra
