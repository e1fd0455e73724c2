#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "toolkit/mesh/context.h"

/// Where positions stand in the files of one mesh. Internal to mesh_file.h.
namespace mimetra {

/// What the files of one mesh have in common, learnt from the first of them.
class MeshLayout {
 public:
  virtual ~MeshLayout() = default;

  /// Reads x y z of each vertex of a further file into `coordinates`. Bytes around the positions
  /// are compared with the first file's. False, with anything in `coordinates`, where they differ
  /// in what faces depend on, where a position is malformed or not finite, or where the file is
  /// written in a way that only the format's whole reader knows.
  virtual bool read(std::string_view bytes, std::span<double> coordinates) const = 0;
};

/// Learn the layout from the bytes of a first file, in which the format's reader found so many
/// vertices. Null if the file is written in a way that only that reader knows. Throw Cancelled.
std::unique_ptr<const MeshLayout> obj_layout(std::string first, std::size_t vertices,
                                             const Context&);
std::unique_ptr<const MeshLayout> ply_layout(std::string first, std::size_t vertices,
                                             const Context&);
std::unique_ptr<const MeshLayout> off_layout(std::string first, std::size_t vertices,
                                             const Context&);

}  // namespace mimetra
