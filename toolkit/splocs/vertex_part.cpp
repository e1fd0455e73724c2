#include "toolkit/splocs/vertex_part.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace mimetra {
namespace {

/// `things` are dealt out to `owners` in order: thing t goes to owner t owners / things, rounded
/// down. Then owner o has these.
IndexRange dealt_to(int owner, int owners, int things) {
  const auto first = [&](std::int64_t o) {
    return static_cast<int>((o * things + owners - 1) / owners);
  };
  return {first(owner), first(std::int64_t{owner} + 1)};
}

int owner_of(int thing, int owners, int things) {
  return static_cast<int>(std::int64_t{thing} * owners / things);
}

}  // namespace

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

int VertexPart::owner_of_run(int run) const {
  return owner_of(run, ranks_, mesh_runs_);
}

int VertexPart::owner(VertexIndex vertex) const {
  const int block = static_cast<int>(vertex / kBlock);
  return owner_of_run(owner_of(block, mesh_runs_, mesh_blocks()));
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
