#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/scene.h"
#include "toolkit/io/usd_text.h"
#include "toolkit/mesh/tri_mesh.h"

/// Prims of a layer of USD: what they refer to, where they stand and when, where skeletons hold
/// meshes at rest, and the faces of meshes. Internal to the format.
///
/// [UsdSkelSkeleton, UsdSkelBindingAPI]
namespace mimetra {

/// A prim and those that it stands in, the innermost last.
using UsdStack = std::vector<const UsdPrim*>;

/// The prim of a path: from the root of the layer or, without a slash before it, from the prim of
/// `from`, with `..` for what that one stands in. Empty where there is none.
UsdStack usd_stack_at(const UsdLayer& layer, const std::string& path, const UsdStack& from);

/// A property, and the prim that has it.
struct UsdOwned {
  UsdStack owner = {};
  const UsdProperty* property = nullptr;
};

/// A property of a prim or, where it has none, of the nearest prim that it stands in; null where
/// none of them has it.
UsdOwned usd_inherited(const UsdStack& stack, const std::string& name);

/// From a prim to the world, at a time code. Throws IoError with the line of what is no transform.
Eigen::Matrix4d usd_world(const std::string& path, const UsdStack& stack,
                          std::optional<double> code = {});

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

/// The faces that the mesh `prim` shows, with texture coordinates, where `part` has its points.
/// Throws IoError with the line of what does not fit.
void fill_usd_faces(const std::string& path, const UsdPrim& prim, ScenePart& part);

/// Turns the faces, each with the coordinates of its corners.
void turn_faces(ScenePart& part);

}  // namespace mimetra
