#include "toolkit/formats/gltf/gltf_motion.h"

#include <algorithm>

#include <Eigen/LU>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

bool mirrors(const Eigen::Matrix<double, 3, 4>& transform) {
  return transform.leftCols<3>().determinant() < 0;
}

}  // namespace

std::vector<PlacedNode> placed_nodes(const GltfDocument& document) {
  std::vector<PlacedNode> placed, open;
  for (auto root = document.roots.rbegin(); root != document.roots.rend(); ++root) {
    open.push_back({*root, {}, Eigen::Matrix4d::Identity()});
  }
  std::vector<bool> met(document.nodes.size(), false);
  while (!open.empty()) {
    PlacedNode here = std::move(open.back());
    open.pop_back();
    if (met[here.node]) {
      throw IoError(document.path, "nodes[" + std::to_string(here.node) +
                                       "] is met twice; nodes must form a tree");
    }
    met[here.node] = true;
    const GltfNode& node = document.nodes[here.node];
    here.world *= node.local;
    if (!node.name.empty()) here.name = node.name;
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      open.push_back({*child, here.name, here.world});
    }
    placed.push_back(std::move(here));
  }
  return placed;
}

std::vector<bool> Placement::mirrored(Eigen::Index vertices) const {
  if (blended_.rows() == 0) {
    return std::vector<bool>(static_cast<std::size_t>(vertices), mirrors(all_));
  }
  std::vector<bool> flags;
  for (Eigen::Index v = 0; v < vertices; ++v) flags.push_back(mirrors(of(v)));
  return flags;
}

void Placement::apply(Positions& points, bool directions) const {
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Transform transform = of(v);
    Eigen::Vector3d moved = transform.leftCols<3>() * points.row(v).transpose();
    if (!directions) moved += transform.col(3);
    points.row(v) = moved;
  }
}

Placement::Transform Placement::of(Eigen::Index vertex) const {
  if (blended_.rows() == 0) return all_;
  return Eigen::Map<const Transform>(blended_.row(vertex).data());
}

namespace {

std::shared_ptr<const WeightCurve> curve_of(const GltfDocument& document, GltfValues& values,
                                            const GltfChannel& channel) {
  const std::size_t targets = document.meshes[*document.nodes[channel.node].mesh].most_targets;
  WeightCurve curve;
  const Frames keys = values.read(channel.times, 1);
  const Eigen::Index count = keys.rows(), columns = static_cast<Eigen::Index>(targets);
  const bool is_cubic = channel.interpolation == "CUBICSPLINE";
  const Frames stored = values.read(channel.values, 1, count * columns * (is_cubic ? 3 : 1));
  using Rows = Eigen::Map<const Frames, 0, Eigen::OuterStride<>>;
  const auto rows = [&](Eigen::Index first) -> Eigen::MatrixXd {
    return Rows(stored.data() + first * columns, count, columns,
                Eigen::OuterStride<>(columns * (is_cubic ? 3 : 1)));
  };
  curve.times = keys.col(0);
  curve.values = rows(is_cubic ? 1 : 0);
  if (is_cubic) {
    curve.between = WeightCurve::Between::cubic;
    curve.slopes_in = rows(0);
    curve.slopes_out = rows(2);
  } else if (channel.interpolation == "STEP") {
    curve.between = WeightCurve::Between::step;
  } else if (channel.interpolation != "LINEAR") {
    throw IoError(document.path, "an animation: has interpolation '" + channel.interpolation + "'");
  }
  return std::make_shared<const WeightCurve>(std::move(curve));
}

/// An animation and its channels that drive targets of shown nodes.
struct GltfClip {
  const GltfAnimation* animation;
  std::vector<const GltfChannel*> channels;
};

GltfClip clip_of(const GltfDocument& document, const GltfAnimation& animation,
                 const std::set<std::size_t>& shown) {
  GltfClip clip{&animation, {}};
  for (const GltfChannel& channel : animation.channels) {
    const auto& mesh = document.nodes[channel.node].mesh;
    if (channel.drives_weights && shown.contains(channel.node) && mesh &&
        document.meshes[*mesh].most_targets > 0) {
      clip.channels.push_back(&channel);
    }
  }
  return clip;
}

bool has_several_keys(const GltfDocument& document, const GltfClip& clip) {
  return std::ranges::any_of(clip.channels, [&](const GltfChannel* channel) {
    return document.accessors[channel->times].count > 1;
  });
}

/// True if a clip that is not yet read would move anything; false if it cannot be read.
bool moves_weights(const GltfDocument& document, GltfValues& values, const GltfClip& clip) {
  std::set<std::pair<std::size_t, std::size_t>> seen;
  return std::ranges::any_of(clip.channels, [&](const GltfChannel* channel) {
    if (!seen.emplace(channel->times, channel->values).second) return false;
    try {
      return !curve_of(document, values, *channel)->is_still();
    } catch (const IoError&) {
      return false;
    }
  });
}

std::string shown_name(const GltfDocument& document, const GltfAnimation& animation) {
  if (!animation.name.empty()) return animation.name;
  return "animations[" + std::to_string(&animation - document.animations.data()) + ']';
}

/// Takes clips in order. A clip that drives weights of an earlier one is left out.
void take_clips(const GltfDocument& document, GltfValues& values,
                const std::vector<GltfClip>& clips, GltfMotion& motion) {
  motion.weights.assign(document.nodes.size(), nullptr);
  motion.clips.clear();
  motion.other_clips.clear();
  for (const GltfClip& clip : clips) {
    const std::string name = "'" + shown_name(document, *clip.animation) + "'";
    const bool is_another = std::ranges::any_of(clip.channels, [&](const GltfChannel* channel) {
      return motion.weights[channel->node] != nullptr;
    });
    (is_another ? motion.other_clips : motion.clips).insert(name);
    if (is_another) continue;
    for (const GltfChannel* channel : clip.channels) {
      auto& weights = motion.weights[channel->node];
      if (!weights) weights = curve_of(document, values, *channel);
    }
  }
}

}  // namespace

GltfMotion gltf_motion(const GltfDocument& document, GltfValues& values,
                       const std::set<std::size_t>& shown) {
  GltfMotion motion;
  std::vector<GltfClip> clips;
  for (const GltfAnimation& animation : document.animations) {
    clips.push_back(clip_of(document, animation, shown));
    motion.unread.insert(animation.unread.begin(), animation.unread.end());
    for (const GltfChannel& channel : animation.channels) {
      if (!channel.drives_weights) motion.moved.insert(channel.node);
    }
  }
  std::erase_if(clips, [](const GltfClip& clip) { return clip.channels.empty(); });
  std::stable_partition(clips.begin(), clips.end(),
                        [&](const GltfClip& clip) { return has_several_keys(document, clip); });
  take_clips(document, values, clips, motion);
  const bool is_still = std::ranges::all_of(
      motion.weights, [](const auto& weights) { return !weights || weights->is_still(); });
  if (is_still && !motion.other_clips.empty()) {
    std::stable_partition(clips.begin(), clips.end(), [&](const GltfClip& clip) {
      return moves_weights(document, values, clip);
    });
    take_clips(document, values, clips, motion);
  }
  return motion;
}

}  // namespace mimetra
