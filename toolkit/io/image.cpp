#include "toolkit/io/image.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace mimetra {

namespace {

class SelectedImages final : public ImageSequence {
 public:
  SelectedImages(std::shared_ptr<const ImageSequence> images, std::vector<int> chosen)
      : images_(std::move(images)), chosen_(std::move(chosen)) {
    const auto is_there = [this](int frame) { return frame >= 0 && frame < images_->frames(); };
    if (std::ranges::all_of(chosen_, is_there)) return;
    throw std::out_of_range("a frame that is none of the " + std::to_string(images_->frames()) +
                            " images");
  }

  int frames() const override { return static_cast<int>(chosen_.size()); }
  Image image(int frame) const override { return images_->image(of(frame)); }
  std::string name(int frame) const override { return images_->name(of(frame)); }
  bool is_recording() const override { return images_->is_recording(); }
  std::filesystem::path sound() const override { return images_->sound(); }
  void check() const override { images_->check(); }

 private:
  int of(int frame) const { return chosen_.at(static_cast<std::size_t>(frame)); }

  std::shared_ptr<const ImageSequence> images_;
  std::vector<int> chosen_;
};

}  // namespace

std::shared_ptr<const ImageSequence> selected(std::shared_ptr<const ImageSequence> images,
                                              std::vector<int> chosen) {
  return std::make_shared<SelectedImages>(std::move(images), std::move(chosen));
}

}  // namespace mimetra
