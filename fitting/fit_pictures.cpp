#include "fitting/fit_pictures.h"

#include <algorithm>
#include <stdexcept>

#include "fitting/image_files.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

FitPictures::FitPictures(std::shared_ptr<const ImageSequence> images, MeshSequence sequence,
                         const FittedCoefficients& fit, MappedLandmarks mapped) {
  Triangles triangles = sequence.triangles();
  clip_ = std::make_shared<const Clip>(Clip{std::move(images), std::move(sequence), fit.cameras,
                                            fit.depths, std::move(mapped), std::move(triangles)});
}

Image FitPictures::image(int frame) const {
  return clip_->images->image(frame);
}

FittedView FitPictures::view(int frame) const {
  const MappedLandmarks& mapped = clip_->mapped;
  const Eigen::RowVectorXd points = mapped.points.row(frame);
  const Eigen::RowVector4d depth =
      clip_->depths.rows() > 0 ? clip_->depths.row(frame) : Eigen::RowVector4d(0, 0, 0, 1);
  return {
      project(clip_->cameras[static_cast<std::size_t>(frame)], clip_->sequence.frame(frame), depth),
      points.reshaped<Eigen::RowMajor>(points.size() / 2, 2), mapped.vertices};
}

Image FitPictures::overlay(int frame) const {
  return draw_fit(image(frame), clip_->triangles, view(frame));
}

Image FitPictures::strip(const std::vector<int>& frames) const {
  constexpr std::size_t kMost = 5;
  constexpr int kHeight = 400;
  const std::size_t count = std::min(kMost, frames.size());
  std::vector<Image> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const int frame = frames[count == 1 ? 0 : i * (frames.size() - 1) / (count - 1)];
    try {
      parts.push_back(draw_close_up(image(frame), clip_->triangles, view(frame), kHeight));
    } catch (const std::invalid_argument&) {
      throw MismatchError(clip_->images->name(frame) +
                          ": the fitted face is outside the image; do the landmarks belong to it?");
    }
  }
  return mimetra::strip(parts, kHeight);
}

}  // namespace mimetra
