#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <dlib/array2d.h>
#include <dlib/image_loader/jpeg_loader.h>
#include <dlib/image_loader/png_loader.h>
#include <dlib/image_processing/frontal_face_detector.h>
#include <dlib/image_processing/shape_predictor.h>

#include "fitting/face_images.h"
#include "fitting/image_codec.h"
#include "toolkit/mesh/errors.h"

/// All that needs dlib.
namespace mimetra {

namespace {

using Pixels = dlib::array2d<dlib::rgb_pixel>;

constexpr unsigned long kModelLandmarks = 68;

Pixels pixels_of(const Image& image) {
  Pixels pixels(image.height, image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Color& color = image.at(x, y);
      pixels[y][x] = dlib::rgb_pixel(color.red, color.green, color.blue);
    }
  }
  return pixels;
}

Image image_of(const Pixels& pixels) {
  Image image(static_cast<int>(pixels.nc()), static_cast<int>(pixels.nr()));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const dlib::rgb_pixel& pixel = pixels[y][x];
      image.at(x, y) = {pixel.red, pixel.green, pixel.blue};
    }
  }
  return image;
}

/// Walks through a stored shape predictor, which dlib would believe: what its trees and anchors
/// refer to must be there, and counts must not exceed the file's bytes.
class PredictorCheck {
 public:
  PredictorCheck(std::istream& file, std::uintmax_t bytes) : file_(file), bytes_(bytes) {}

  void run() {
    next<int>();  // version, which dlib checks
    if (numbers() != 2 * kModelLandmarks) fail("its mean face does not have 68 landmarks");
    std::vector<unsigned long> largest;  // feature that the trees of each cascade compare
    for (unsigned long left = count(); left > 0; --left) largest.push_back(largest_of_trees());
    std::vector<unsigned long> anchors;
    if (count() != largest.size()) fail("its cascades have not each their anchors");
    for (std::size_t i = 0; i < largest.size(); ++i) {
      anchors.push_back(count());
      for (unsigned long left = anchors.back(); left > 0; --left) {
        if (next<unsigned long>() >= kModelLandmarks) fail("an anchor is no landmark");
      }
    }
    if (count() != largest.size()) fail("its cascades have not each their offsets");
    for (std::size_t i = 0; i < largest.size(); ++i) {
      const unsigned long features = count();
      if (features != anchors[i] || largest[i] >= features)
        fail("a tree compares what is not there");
      for (unsigned long left = 2 * features; left > 0; --left) next<float>();
    }
  }

 private:
  [[noreturn]] static void fail(const std::string& problem) { throw std::runtime_error(problem); }

  template <typename Number>
  Number next() {
    Number number{};
    dlib::deserialize(number, file_);
    return number;
  }

  /// Every entry takes a byte at least.
  unsigned long count() {
    const auto number = next<unsigned long>();
    if (number > bytes_) fail("counts " + std::to_string(number) + " entries, more than bytes");
    return number;
  }

  /// How many numbers a column holds; passes over them. Its sizes stand negated in the file.
  unsigned long numbers() {
    const long rows = next<long>(), columns = next<long>();
    if (columns != -1 || rows > 0 || rows < -static_cast<long>(bytes_)) fail("an odd matrix");
    for (long left = rows; left < 0; ++left) next<float>();
    return static_cast<unsigned long>(-rows);
  }

  /// Of a cascade's trees, each with a leaf more than it has splits.
  unsigned long largest_of_trees() {
    unsigned long largest = 0;
    for (unsigned long trees = count(); trees > 0; --trees) {
      const unsigned long splits = count();
      for (unsigned long left = splits; left > 0; --left) {
        largest = std::max({largest, next<unsigned long>(), next<unsigned long>()});
        next<float>();
      }
      if (count() != splits + 1) fail("a tree has not a leaf more than splits");
      for (unsigned long left = splits + 1; left > 0; --left) {
        if (numbers() != 2 * kModelLandmarks) fail("a leaf does not move 68 landmarks");
      }
    }
    return largest;
  }

  std::istream& file_;
  std::uintmax_t bytes_;
};

dlib::shape_predictor read_predictor(const std::filesystem::path& model) {
  std::error_code unreadable;
  std::ifstream file(model, std::ios::binary);
  if (!file || !std::filesystem::is_regular_file(model, unreadable)) {
    throw IoError(model.string(),
                  "the 68-point face model cannot be read; install the package libdlib-data, or "
                  "name another model");
  }
  dlib::shape_predictor predictor;
  try {
    PredictorCheck(file, std::filesystem::file_size(model)).run();
    file.seekg(0);
    dlib::deserialize(predictor, file);
  } catch (const std::exception& error) {  // a damaged count may also ask for too much memory
    throw IoError(model.string(), std::string("is no shape predictor of dlib: ") + error.what());
  }
  if (predictor.num_parts() != kModelLandmarks) {
    throw IoError(model.string(), "finds " + std::to_string(predictor.num_parts()) +
                                      " landmarks, expected a model of iBUG's 68");
  }
  return predictor;
}

Face face_of(const dlib::rect_detection& found, const dlib::full_object_detection& shape) {
  Face face;
  face.left = double(found.rect.left());
  face.top = double(found.rect.top());
  face.width = double(found.rect.width());
  face.height = double(found.rect.height());
  // Found faces are above the threshold; not all after they were sorted out.
  const double score = std::max(0.0, found.detection_confidence);
  face.confidence = score / (1 + score);
  face.landmarks.resize(kModelLandmarks, 2);
  for (unsigned long i = 0; i < kModelLandmarks; ++i) {
    face.landmarks.row(static_cast<Eigen::Index>(i)) << double(shape.part(i).x()),
        double(shape.part(i).y());
  }
  return face;
}

}  // namespace

struct FaceFinder::State {
  dlib::frontal_face_detector detector;
  dlib::shape_predictor predictor;
};

FaceFinder::FaceFinder(const std::filesystem::path& model)
    : state_(std::make_unique<State>(
          State{dlib::get_frontal_face_detector(), read_predictor(model)})) {}
FaceFinder::~FaceFinder() = default;
FaceFinder::FaceFinder(FaceFinder&&) noexcept = default;
FaceFinder& FaceFinder::operator=(FaceFinder&&) noexcept = default;

std::vector<Face> FaceFinder::faces(const Image& image) const {
  dlib::frontal_face_detector detector = state_->detector;  // it keeps the image's features
  const Pixels pixels = pixels_of(image);
  std::vector<dlib::rect_detection> found;
  detector(pixels, found);
  std::vector<Face> faces;
  for (const dlib::rect_detection& face : found) {
    faces.push_back(face_of(face, state_->predictor(pixels, face.rect)));
  }
  return faces;
}

void require_dlib(const std::string&) {}

Image decoded_image(const std::string& name, const std::string& bytes, const ImageHeader& header) {
  const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
  Pixels pixels;
  try {
    if (header.is_png) {
      dlib::png_loader(begin, bytes.size()).get_image(pixels);
    } else {
      dlib::jpeg_loader(begin, bytes.size()).get_image(pixels);
    }
  } catch (const dlib::error& error) {
    throw IoError(name, std::string("the image is damaged: ") + error.what());
  }
  return image_of(pixels);
}

}  // namespace mimetra
