#include "toolkit/splocs/vertex_part.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace mimetra {

VertexPart::VertexPart(Eigen::Index mesh_vertices, int rank, int ranks)
    : mesh_vertices_(mesh_vertices), rank_(rank), ranks_(ranks) {
  if (rank < 0 || rank >= ranks) {
    throw std::invalid_argument("rank " + std::to_string(rank) + " of " + std::to_string(ranks));
  }
  mesh_runs_ = std::min(kMostRuns, mesh_blocks());
  runs_ = dealt_to(rank, ranks, mesh_runs_);
  if (runs_.count() > 0) {
    blocks_ = {mesh_blocks_of(runs_.first).first, mesh_blocks_of(runs_.end - 1).end};
  }
}

Eigen::Index VertexPart::vertices() const {
  return std::min(mesh_vertices_, blocks_.end * kBlock) - first();
}

IndexRange VertexPart::blocks_of(int run) const {
  const IndexRange blocks = mesh_blocks_of(run);
  return {blocks.first - blocks_.first, blocks.end - blocks_.first};
}

int VertexPart::owner(VertexIndex vertex) const {
  const int block = static_cast<int>(vertex / kBlock);
  return owner_of(owner_of(block, mesh_runs_, mesh_blocks()), ranks_, mesh_runs_);
}

int VertexPart::mesh_blocks() const {
  return static_cast<int>((mesh_vertices_ + kBlock - 1) / kBlock);
}

IndexRange VertexPart::mesh_blocks_of(int run) const {
  return dealt_to(run, mesh_runs_, mesh_blocks());
}

std::shared_ptr<const FrameSource> own_vertices(const FrameSource& sequence,
                                                const VertexPart& part) {
  const std::shared_ptr<const FrameSource> whole(std::shared_ptr<const FrameSource>(), &sequence);
  return some_vertices(whole, static_cast<VertexIndex>(part.first()),
                       static_cast<int>(part.vertices()));
}

}  // namespace mimetra
