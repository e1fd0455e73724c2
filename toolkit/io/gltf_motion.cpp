#include "toolkit/io/gltf_motion.h"

#include <algorithm>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

std::shared_ptr<const WeightCurve> curve_of(const GltfDocument& document, GltfValues& values,
                                            const GltfChannel& channel) {
  const std::size_t targets = document.meshes[*document.nodes[channel.node].mesh].most_targets();
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

/// An animation, and its channels that drive targets which are shown.
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
        document.meshes[*mesh].most_targets() > 0) {
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

/// Whether any weight changes over time, as far as one can tell of a clip that may be left out.
bool changes_weights(const GltfDocument& document, GltfValues& values, const GltfClip& clip) {
  return std::ranges::any_of(clip.channels, [&](const GltfChannel* channel) {
    const Frames stored = values.read(channel->values, 1);
    const auto keys = static_cast<Eigen::Index>(document.accessors[channel->times].count);
    if (stored.rows() % keys != 0) return true;
    const auto of_keys = stored.reshaped<Eigen::RowMajor>(keys, stored.rows() / keys);
    return (of_keys.rowwise() - of_keys.row(0)).any();
  });
}

std::string shown_name(const GltfDocument& document, const GltfAnimation& animation) {
  if (!animation.name.empty()) return animation.name;
  return "animations[" + std::to_string(&animation - document.animations.data()) + ']';
}

}  // namespace

GltfMotion gltf_motion(const GltfDocument& document, GltfValues& values,
                       const std::set<std::size_t>& shown) {
  GltfMotion motion;
  motion.weights.resize(document.nodes.size());
  std::vector<GltfClip> clips;
  for (const GltfAnimation& animation : document.animations) {
    clips.push_back(clip_of(document, animation, shown));
    motion.unread.insert(animation.unread.begin(), animation.unread.end());
    for (const GltfChannel& channel : animation.channels) {
      if (!channel.drives_weights) motion.moved.insert(channel.node);
    }
  }
  std::erase_if(clips, [](const GltfClip& clip) { return clip.channels.empty(); });
  if (clips.size() > 1) {
    const auto poses = std::stable_partition(clips.begin(), clips.end(), [&](const GltfClip& clip) {
      return has_several_keys(document, clip);
    });
    std::stable_partition(clips.begin(), poses, [&](const GltfClip& clip) {
      return changes_weights(document, values, clip);
    });
  }
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
  return motion;
}

}  // namespace mimetra
