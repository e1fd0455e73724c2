#include "fitting/landmarks_of_drawings.h"

#include <memory>
#include <mutex>

namespace mimetra {

namespace {

/// A hundred megabytes, for those who draw heads only.
class FinderOnDemand {
 public:
  explicit FinderOnDemand(std::filesystem::path model) : model_(std::move(model)) {}

  const FaceFinder& get() {
    const std::lock_guard lock(mutex_);
    if (!finder_) finder_.emplace(model_);
    return *finder_;
  }

 private:
  std::filesystem::path model_;
  std::mutex mutex_;
  std::optional<FaceFinder> finder_;
};

Image colored(const GreyImage& grey) {
  Image image(grey.width, grey.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {grey.pixels[i], grey.pixels[i], grey.pixels[i]};
  }
  return image;
}

}  // namespace

LandmarkFinder landmarks_of_drawings(const std::filesystem::path& model) {
  const auto finder = std::make_shared<FinderOnDemand>(model);
  return [finder](const GreyImage& drawing) -> std::optional<FoundFace> {
    const std::vector<Face> faces = finder->get().faces(colored(drawing));
    if (faces.empty()) return {};
    return FoundFace{faces.front().landmarks, faces.front().confidence};
  };
}

}  // namespace mimetra
