#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "toolkit/io/usd_path.h"

/// Where prims of a layer of USD stand, and when. Internal to the format.
namespace mimetra {

/// From a prim to the world, at a time code. Throws IoError with the line of what is no transform.
Eigen::Matrix4d usd_world(const std::string& path, const UsdStack& stack,
                          std::optional<double> code = {});

}  // namespace mimetra
