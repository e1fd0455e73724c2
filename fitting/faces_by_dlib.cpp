#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <dlib/array2d.h>
#include <dlib/image_processing/frontal_face_detector.h>
#include <dlib/image_processing/shape_predictor.h>
#include <dlib/image_transforms.h>

#include "fitting/face_finder.h"
#include "fitting/image_files.h"
#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/io/image.h"
#include "toolkit/mesh/errors.h"

/// Everything that needs dlib, which sees an image as rows of its own pixels.
namespace dlib {

static_assert(sizeof(rgb_pixel) == sizeof(mimetra::Color));

// NOLINTBEGIN(readability-identifier-naming): dlib's name
template <>
struct image_traits<mimetra::Image> {
  using pixel_type = rgb_pixel;
};
template <>
struct image_traits<const mimetra::Image> {
  using pixel_type = rgb_pixel;
};
// NOLINTEND(readability-identifier-naming)

}  // namespace dlib

namespace mimetra {

static long num_rows(const Image& image) {
  return image.height;
}
static long num_columns(const Image& image) {
  return image.width;
}
static long width_step(const Image& image) {
  return image.width * static_cast<long>(sizeof(Color));
}
static const void* image_data(const Image& image) {
  return image.pixels.data();
}

namespace {

constexpr unsigned long kModelLandmarks = kFaceLandmarks;

/// Validates a stored shape predictor, which dlib would trust. References of trees and anchors must
/// be valid, and counts must not exceed the bytes of the file.
class PredictorCheck {
 public:
  PredictorCheck(std::istream& file, std::uintmax_t bytes) : file_(file), bytes_(bytes) {}

  void run() {
    next<int>();  // version, which dlib checks
    if (numbers() != 2 * kModelLandmarks) fail("its mean face does not have 68 landmarks");
    std::vector<unsigned long> largest;  // largest feature that the trees of each cascade compare
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

  /// Reads a count, which cannot exceed the number of bytes.
  unsigned long count() {
    const auto number = next<unsigned long>();
    if (number > bytes_) fail("counts " + std::to_string(number) + " entries, more than bytes");
    return number;
  }

  /// Skips a column and returns its length. The file holds its sizes negated.
  unsigned long numbers() {
    const long rows = next<long>(), columns = next<long>();
    if (columns != -1 || rows > 0 || rows < -static_cast<long>(bytes_)) fail("an odd matrix");
    for (long left = rows; left < 0; ++left) next<float>();
    return static_cast<unsigned long>(-rows);
  }

  /// Largest feature of a cascade's trees. Each tree has one leaf more than splits.
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
  } catch (const std::exception& error) {  // damaged counts may also ask for too much memory
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
  // A face scores above the threshold, but not always after overlapping faces are sorted out.
  const double score = std::max(0.0, found.detection_confidence);
  face.confidence = score / (1 + score);
  face.landmarks.resize(kModelLandmarks, 2);
  for (unsigned long i = 0; i < kModelLandmarks; ++i) {
    face.landmarks.row(static_cast<Eigen::Index>(i)) << double(shape.part(i).x()),
        double(shape.part(i).y());
  }
  return face;
}

using Detector = dlib::frontal_face_detector;
using Detections = std::vector<dlib::rect_detection>;

/// Detector for faces of one size, without an image pyramid.
Detector of_one_level(const Detector& detector) {
  Detector::image_scanner_type scanner;
  scanner.copy_configuration(detector.get_scanner());
  scanner.set_max_pyramid_levels(1);
  std::vector<Detector::feature_vector_type> weights;
  for (unsigned long i = 0; i < detector.num_detectors(); ++i) weights.push_back(detector.get_w(i));
  return {scanner, detector.get_overlap_tester(), weights};
}

/// Searches for faces near the size and place of the last one: in three levels of the pyramid of a
/// part around it. Windows are at the places of a search of the whole image, to within a pixel of
/// the level.
Detections found_near(const Image& image, const Face& last, Detector& one_level) {
  using Pyramid = dlib::pyramid_down<6>;
  constexpr double kStep = 6.0 / 5;    // from one level to the level before
  constexpr double kWindow = 72;       // pixels of a face in its level
  constexpr double kCell = 8;          // pixels between windows
  constexpr double kEdge = 3 * kCell;  // cells at an edge lack gradients from beyond it
  const auto middle =
      static_cast<int>(std::max(std::lround(std::log(last.width / kWindow) / std::log(kStep)), 0L));
  // Half of the face, the same distance again for its motion, and the edge.
  const double half = last.width + kEdge * std::pow(kStep, middle + 1);
  const auto begin = [half](double center, int size) {
    return static_cast<int>(std::clamp(center - half, 0.0, size - 1.0));
  };
  const int left = begin(last.left + last.width / 2, image.width);
  const int top = begin(last.top + last.height / 2, image.height);
  const int side = static_cast<int>(2 * half) + 1;
  dlib::array2d<dlib::rgb_pixel> pixels, smaller;
  dlib::assign_image(pixels, cropped(image, left, top, side, side));
  Detections found;
  for (int level = 0; level <= middle + 1 && pixels.size() > 0; ++level) {
    if (level >= middle - 1) {
      const auto to_cell = [&](int place) {
        const double in_level = place * std::pow(kStep, -level);
        return std::lround(std::ceil(in_level / kCell) * kCell - in_level);
      };
      const long x = to_cell(left), y = to_cell(top);
      const dlib::rectangle all(x, y, pixels.nc() - 1, pixels.nr() - 1);
      Detections of_level;
      if (!all.is_empty()) one_level(dlib::sub_image(pixels, all), of_level);
      for (dlib::rect_detection& face : of_level) {
        const dlib::rectangle placed = dlib::translate_rect(face.rect, x, y);
        face.rect = dlib::translate_rect(Pyramid().rect_up(placed, static_cast<unsigned>(level)),
                                         left, top);
        found.push_back(face);
      }
    }
    Pyramid()(pixels, smaller);
    pixels.swap(smaller);
  }
  return found;
}

/// Keeps the best of overlapping detections, best first.
Detections best_of(Detections found, const dlib::test_box_overlap& overlap) {
  std::ranges::stable_sort(found, std::ranges::greater(),
                           &dlib::rect_detection::detection_confidence);
  Detections best;
  for (const dlib::rect_detection& face : found) {
    const auto hides = [&](const auto& better) { return overlap(better.rect, face.rect); };
    if (std::ranges::none_of(best, hides)) best.push_back(face);
  }
  return best;
}

}  // namespace

struct FaceFinder::State {
  explicit State(const std::filesystem::path& model) : predictor(read_predictor(model)) {}

  std::vector<Face> faces(const Image& image, const Detections& found) const {
    std::vector<Face> faces;
    for (const dlib::rect_detection& face : found) {
      faces.push_back(face_of(face, predictor(image, face.rect)));
    }
    return faces;
  }

  dlib::shape_predictor predictor;  // first member, so a bad model fails before detectors are made
  Detector detector = dlib::get_frontal_face_detector();
  Detector one_level = of_one_level(detector);
};

FaceFinder::FaceFinder(const std::filesystem::path& model)
    : state_(std::make_unique<State>(model)) {}
FaceFinder::~FaceFinder() = default;
FaceFinder::FaceFinder(FaceFinder&&) noexcept = default;
FaceFinder& FaceFinder::operator=(FaceFinder&&) noexcept = default;

std::vector<Face> FaceFinder::faces(const Image& image) const {
  Detector detector = state_->detector;  // the detector stores features of the image
  Detections found;
  detector(image, found);
  return state_->faces(image, found);
}

std::vector<Face> FaceFinder::faces_near(const Image& image, const std::vector<Face>& last) const {
  Detector one_level = state_->one_level;  // the detector stores features of the image
  Detections found;
  for (const Face& face : last) {
    const Detections near = found_near(image, face, one_level);
    found.insert(found.end(), near.begin(), near.end());
  }
  return state_->faces(image, best_of(found, state_->detector.get_overlap_tester()));
}

bool faces_can_be_found() {
  return true;
}

void require_dlib(const std::string&) {}

}  // namespace mimetra
