#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <dlib/array2d.h>
#include <dlib/image_loader/jpeg_loader.h>
#include <dlib/image_loader/png_loader.h>
#include <dlib/image_processing/frontal_face_detector.h>
#include <dlib/image_processing/shape_predictor.h>

#include "fitting/face_finder.h"
#include "fitting/image_codec.h"
#include "fitting/image_files.h"
#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/image.h"

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

using Pixels = dlib::array2d<dlib::rgb_pixel>;

constexpr unsigned long kModelLandmarks = kFaceLandmarks;

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

/// Columns or rows from `first` to before `last`.
struct PixelRange {
  int first = 0;
  int last = 0;

  int size() const { return last - first; }
};

struct PixelArea {
  PixelRange columns;
  PixelRange rows;
};

/// Part of a pyramid level.
struct PyramidPart {
  PixelArea area;
  Image pixels;
};

bool is_empty(const PixelArea& area) {
  return area.columns.size() <= 0 || area.rows.size() <= 0;
}

PixelRange joined(const PixelRange& a, const PixelRange& b) {
  return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

/// Step between neighbouring pixels of a level, in pixels of the level before it.
double step_between(const PixelRange& before, const PixelRange& after) {
  return (before.last - 1) / static_cast<double>(std::max(after.last - 1, 1));
}

/// A pixel, its successor, and the weight of the successor.
struct Between {
  int first;
  int second;
  float share;
};

std::vector<Between> places(const PixelRange& before, const PixelRange& after,
                            const PixelRange& wanted) {
  const double step = step_between(before, after);
  std::vector<Between> found;
  for (int i = wanted.first; i < wanted.last; ++i) {
    const double place = i * step;
    const int first = std::min(static_cast<int>(place), before.last - 1);
    found.push_back(
        {first, std::min(first + 1, before.last - 1), static_cast<float>(place - first)});
  }
  return found;
}

PixelRange source_of(const PixelRange& before, const PixelRange& after, const PixelRange& wanted) {
  const double step = step_between(before, after);
  return {std::min(static_cast<int>(wanted.first * step), before.last - 1),
          std::min(static_cast<int>((wanted.last - 1) * step) + 2, before.last)};
}

PyramidPart part_of(const PyramidPart& all, const PixelArea& area) {
  if (is_empty(area)) return {area, {}};
  return {area,
          cropped(all.pixels, area.columns.first - all.area.columns.first,
                  area.rows.first - all.area.rows.first, area.columns.size(), area.rows.size())};
}

/// Smallest area that contains both. Empty areas are ignored.
PixelArea joined(const PixelArea& a, const PixelArea& b) {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  return {joined(a.columns, b.columns), joined(a.rows, b.rows)};
}

/// Image pyramid that computes only parts of its levels, with the same pixels as the whole. Each
/// level has five sixths of the columns and rows of the level before it and interpolates between
/// its pixels. The corner pixels coincide.
class DetectorPyramid {
 public:
  /// Makes levels down to `least` columns and rows. Level 0 is the image, which must outlive this.
  DetectorPyramid(const Image& image, int least) : image_(image) {
    int width = image.width, height = image.height;
    do {
      whole_.push_back({{0, width}, {0, height}});
      width = 5 * width / 6;
      height = 5 * height / 6;
    } while (width >= least && height >= least);
  }

  int levels() const { return static_cast<int>(whole_.size()); }
  /// Area of a whole level.
  const PixelArea& whole(int level) const { return whole_.at(static_cast<std::size_t>(level)); }

  /// Computes the pixels of the areas `wanted`, one for each of the first levels. Empty areas are
  /// allowed. \pre areas are inside their levels
  std::vector<PyramidPart> parts(const std::vector<PixelArea>& wanted) const {
    std::vector<PyramidPart> parts;
    parts.reserve(wanted.size());
    for (const PixelArea& area : wanted) parts.push_back({area, {}});
    // The source of each area must be computed in the level before it.
    for (int level = static_cast<int>(parts.size()) - 1; level > 0; --level) {
      const PixelArea& area = parts[static_cast<std::size_t>(level)].area;
      if (is_empty(area)) continue;
      PixelArea& before = parts[static_cast<std::size_t>(level) - 1].area;
      before = joined(before, source_of(level, area));
    }
    for (int level = 0; level < static_cast<int>(parts.size()); ++level) {
      auto& [area, pixels] = parts[static_cast<std::size_t>(level)];
      if (is_empty(area)) continue;
      if (level > 0) {
        pixels = interpolated(parts[static_cast<std::size_t>(level) - 1], level, area);
        continue;
      }
      pixels = cropped(image_, area.columns.first, area.rows.first, area.columns.size(),
                       area.rows.size());
    }
    for (std::size_t level = 0; level < parts.size(); ++level) {
      parts[level] = part_of(parts[level], wanted[level]);
    }
    return parts;
  }

 private:
  /// Pixels of the level before that an area is interpolated from.
  PixelArea source_of(int level, const PixelArea& area) const {
    const PixelArea &before = whole(level - 1), &after = whole(level);
    return {mimetra::source_of(before.columns, after.columns, area.columns),
            mimetra::source_of(before.rows, after.rows, area.rows)};
  }

  Image interpolated(const PyramidPart& before, int level, const PixelArea& area) const {
    const auto columns = places(whole(level - 1).columns, whole(level).columns, area.columns);
    const auto rows = places(whole(level - 1).rows, whole(level).rows, area.rows);
    Image image(area.columns.size(), area.rows.size());
    const int left = before.area.columns.first, top = before.area.rows.first;
    for (int y = 0; y < image.height; ++y) {
      const Between& row = rows[static_cast<std::size_t>(y)];
      const Color* upper = &before.pixels.at(0, row.first - top);
      const Color* lower = &before.pixels.at(0, row.second - top);
      for (int x = 0; x < image.width; ++x) {
        const Between& column = columns[static_cast<std::size_t>(x)];
        const float lower_left = row.share * (1 - column.share);
        const float lower_right = row.share * column.share;
        const float upper_left = (1 - row.share) * (1 - column.share);
        const float upper_right = (1 - row.share) * column.share;
        const auto mixed = [&](std::uint8_t Color::*channel) {
          // Truncates as dlib does instead of rounding.
          return static_cast<std::uint8_t>(
              upper_left * float(upper[column.first - left].*channel) +
              upper_right * float(upper[column.second - left].*channel) +
              lower_left * float(lower[column.first - left].*channel) +
              lower_right * float(lower[column.second - left].*channel));
        };
        image.at(x, y) = {mixed(&Color::red), mixed(&Color::green), mixed(&Color::blue)};
      }
    }
    return image;
  }

  const Image& image_;
  std::vector<PixelArea> whole_;
};

/// Searches for faces near the size and place of the last one: in three levels of the pyramid, each
/// in a part around the face. Its windows are on the grid of the whole level and give the same
/// detections.
class NearSearch {
 public:
  NearSearch(const Image& image, const Detector& one_level)
      : pyramid_(image, kLeastLevel), detector_(one_level) {}

  Detections around(const Face& last) {
    const double level = std::log(last.width / kWindow) / std::log(kStep);
    const int middle = std::clamp(static_cast<int>(std::lround(level)), 0, pyramid_.levels() - 1);
    const int first = std::max(middle - 1, 0), end = std::min(middle + 2, pyramid_.levels());
    std::vector<PixelArea> wanted(static_cast<std::size_t>(end));
    for (int l = first; l < end; ++l) wanted[static_cast<std::size_t>(l)] = area_of(last, l);
    const std::vector<PyramidPart> parts = pyramid_.parts(wanted);
    Detections found;
    for (int l = first; l < end; ++l) add(parts[static_cast<std::size_t>(l)], l, found);
    return found;
  }

 private:
  static constexpr double kStep = 6.0 / 5;  ///< from one level to the level before
  static constexpr int kWindow = 72;        ///< pixels of a face in its level
  static constexpr int kLeastLevel = 64;    ///< the detector makes no smaller levels
  static constexpr int kCell = 8;           ///< pixels between windows
  /// Cells at the edge of a part lack gradients from beyond it. Their windows are dropped.
  static constexpr int kEdge = 2 * kCell;

  /// Half of the face, the same distance again for its motion, and the edge.
  PixelArea area_of(const Face& last, int level) const {
    const double scale = std::pow(kStep, -level);
    const double half = scale * last.width + kEdge;
    const PixelArea& whole = pyramid_.whole(level);
    const auto range = [&](double middle, const PixelRange& all) -> PixelRange {
      const auto cell = [&](double at) {
        return kCell * static_cast<int>(std::clamp(at, 0.0, double(all.last)) / kCell);
      };
      return {std::min(cell(middle - half), all.last - 1),
              std::min(cell(middle + half) + kCell, all.last)};
    };
    return {range(scale * (last.left + last.width / 2), whole.columns),
            range(scale * (last.top + last.height / 2), whole.rows)};
  }

  void add(const PyramidPart& part, int level, Detections& found) {
    const auto& [area, pixels] = part;
    const PixelArea& whole = pyramid_.whole(level);
    const auto edge = [](bool is_own) { return is_own ? 2L * kWindow : -long{kEdge}; };
    const dlib::rectangle counted(-edge(area.columns.first == 0), -edge(area.rows.first == 0),
                                  pixels.width - 1 + edge(area.columns.last == whole.columns.last),
                                  pixels.height - 1 + edge(area.rows.last == whole.rows.last));
    Detections of_part;
    detector_(pixels, of_part);
    for (dlib::rect_detection& face : of_part) {
      if (!counted.contains(face.rect)) continue;
      const dlib::rectangle placed =
          dlib::translate_rect(face.rect, area.columns.first, area.rows.first);
      face.rect = dlib::pyramid_down<6>().rect_up(placed, static_cast<unsigned>(level));
      found.push_back(face);
    }
  }

  DetectorPyramid pyramid_;
  Detector detector_;  ///< the detector stores features of the image
};

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
  NearSearch search(image, state_->one_level);
  Detections found;
  for (const Face& face : last) {
    const Detections near = search.around(face);
    found.insert(found.end(), near.begin(), near.end());
  }
  return state_->faces(image, best_of(found, state_->detector.get_overlap_tester()));
}

bool faces_can_be_found() {
  return true;
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
