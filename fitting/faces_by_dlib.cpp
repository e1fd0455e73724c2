#include <algorithm>
#include <cstring>
#include <fstream>

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

dlib::shape_predictor read_predictor(const std::filesystem::path& model) {
  std::ifstream file(model, std::ios::binary);
  if (!file) {
    throw IoError(model.string(),
                  "the 68-point face model cannot be read; install the package libdlib-data, or "
                  "name another model");
  }
  dlib::shape_predictor predictor;
  try {
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
    : state_(std::make_unique<State>(dlib::get_frontal_face_detector(), read_predictor(model))) {}
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
