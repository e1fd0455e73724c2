#include "toolkit/operations/lost_expressions.h"

#include <filesystem>

#include "toolkit/io/mesh_formats.h"
#include "toolkit/io/scene.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/model/animation.h"
#include "toolkit/operations/counted.h"
#include "toolkit/operations/weight_tables.h"

namespace mimetra {

void warn_of_lost_expressions(const Invocation& invocation, const FrameSource& frames,
                              KeptInScenes kept) {
  const auto* animation = dynamic_cast<const Animation*>(&frames);
  const auto paths = invocation.wanted.find("out");
  if (!animation || animation->model().expressions().size() == 0 || animation->frames() > 1 ||
      !animation->weights().isZero(0) || paths == invocation.wanted.end() ||
      paths->second.empty()) {
    return;
  }
  const std::filesystem::path& path = paths->second.front();
  const bool is_one_mesh = is_mesh_extension(path.extension().string());
  const bool holds_them = kept == KeptInScenes::yes && is_scene_file(path);
  if (is_one_mesh || holds_them || is_weight_file(path.string())) return;
  invocation.warn(
      path.string() + ": holds the neutral alone, not the " +
      counted(animation->model().expressions().size(), "expression") + " of the model; " +
      (kept == KeptInScenes::yes ? ".glb and .usda hold them, and " : "") + "--weights moves them");
}

}  // namespace mimetra
