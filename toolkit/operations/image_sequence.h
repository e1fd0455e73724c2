#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "toolkit/operations/image.h"

namespace mimetra {

/// What the frames of a clip show, each image read when it is asked for.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;

  virtual int frames() const = 0;
  /// Quickest frame after frame. May be called from several threads. Throws IoError;
  /// std::out_of_range for a frame that is not there.
  virtual Image image(int frame) const = 0;
  /// What messages call a frame: "a/1.png", "clip.mp4, frame 12".
  virtual std::string name(int frame) const = 0;
  /// True for frames of one recording: what one shows is near where the last one showed it.
  virtual bool is_recording() const { return false; }
  /// The file whose sound belongs to the frames, or none.
  virtual std::filesystem::path sound() const { return {}; }
  /// Throws IoError for what image() would refuse, as far as that shows without decoding.
  virtual void check() const = 0;

 protected:
  ImageSequence() = default;
  ImageSequence(const ImageSequence&) = default;
  ImageSequence& operator=(const ImageSequence&) = default;
};

/// The frames `chosen` of a sequence, in this order. Throws std::out_of_range for frames that are
/// not there.
std::shared_ptr<const ImageSequence> selected(std::shared_ptr<const ImageSequence> images,
                                              std::vector<int> chosen);

}  // namespace mimetra
