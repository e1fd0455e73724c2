#include "toolkit/io/painting_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "toolkit/io/csv.h"
#include "toolkit/io/image_decoder.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

const std::vector<std::string> kPictures = {".png", ".jpg", ".jpeg"};

/// Luma with the weights of Rec. 601 in thousandths. Grey values stay exact.
std::uint16_t luma_of(const std::uint16_t* rgb) {
  return static_cast<std::uint16_t>((299U * rgb[0] + 587U * rgb[1] + 114U * rgb[2] + 500U) / 1000U);
}

/// Brightness and opacity of pixels. Colours are not kept, since large textures would need a
/// gigabyte.
struct Pixels : PixelSink {
  /// height x width, from the top left.
  using Plane = Eigen::Matrix<std::uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void begin(const PictureSize& size) override {
    const auto height = static_cast<Eigen::Index>(size.height);
    const auto width = static_cast<Eigen::Index>(size.width);
    luma.resize(height, width);
    if (size.has_opacity) opacity.resize(height, width);
  }

  void take(std::uint64_t row, std::uint64_t column, std::uint64_t step,
            std::span<const std::uint16_t> rgba) override {
    // Channels of a grey image differ by at most this much after compression.
    constexpr int kColored = 65535 / 16;
    const auto y = static_cast<Eigen::Index>(row);
    for (; !rgba.empty(); rgba = rgba.subspan(4), column += step) {
      const std::uint16_t* pixel = rgba.data();
      const auto x = static_cast<Eigen::Index>(column);
      luma(y, x) = luma_of(pixel);
      if (opacity.size() > 0) opacity(y, x) = pixel[3];
      if (!has_first_) std::copy_n(pixel, 4, first_.begin());
      has_first_ = true;
      colors_differ = colors_differ || !std::equal(pixel, pixel + 3, first_.begin());
      opacities_differ = opacities_differ || pixel[3] != first_[3];
      const auto [least, most] = std::minmax({pixel[0], pixel[1], pixel[2]});
      is_colored = is_colored || most - least > kColored;
    }
  }

  Plane luma;
  Plane opacity;  ///< empty if the file has none
  bool colors_differ = false;
  bool opacities_differ = false;
  bool is_colored = false;  ///< some pixels are not grey

 private:
  std::array<std::uint16_t, 4> first_ = {};
  bool has_first_ = false;
};

/// Value over a black background; exact for opaque pixels.
std::uint16_t over_black(std::uint32_t value, std::uint32_t opacity) {
  constexpr std::uint32_t kOpaque = 65535;
  return static_cast<std::uint16_t>((value * opacity + kOpaque / 2) / kOpaque);
}

/// Two neighbouring pixels, and the position between them from 0 to 1.
struct Between {
  Eigen::Index first;
  Eigen::Index second;
  double share;
};

bool is_within(double place) {
  return place >= -Brightness::kRounding && place <= 1 + Brightness::kRounding;
}

/// Converts a place of the texture to one of the picture, in [0, 1].
double in_picture(double place) {
  return is_within(place) ? std::clamp(place, 0.0, 1.0) : place - std::floor(place);
}

Between pixels_around(double place, Eigen::Index count) {
  const double last = static_cast<double>(count) - 1;
  const double from_center = std::clamp(place * static_cast<double>(count) - 0.5, 0.0, last);
  const double whole = std::floor(from_center);
  const auto first = static_cast<Eigen::Index>(whole);
  return {first, std::min(first + 1, count - 1), from_center - whole};
}

}  // namespace

bool Brightness::is_beyond(double u, double v) {
  return !is_within(u) || !is_within(v);
}

double Brightness::at(double u, double v) const {
  const Between x = pixels_around(in_picture(u), pixels.cols());
  const Between y = pixels_around(1 - in_picture(v), pixels.rows());
  const auto in_row = [&](Eigen::Index row) {
    const double left = pixels(row, x.first), right = pixels(row, x.second);
    return left + x.share * (right - left);
  };
  const double upper = in_row(y.first), lower = in_row(y.second);
  return (upper + y.share * (lower - upper)) / kWhite;
}

Brightness read_brightness(const std::filesystem::path& path) {
  const std::string name = path.string();
  Pixels pixels;
  decode_picture(name, read_file(path), pixels);
  const bool by_opacity = pixels.opacities_differ && !pixels.colors_differ;
  Brightness brightness{std::move(by_opacity ? pixels.opacity : pixels.luma)};
  if (by_opacity) {
    brightness.notes.push_back(name + ": all of it has one colour; its opacity is taken");
    return brightness;
  }
  if (pixels.is_colored) {
    brightness.notes.push_back(name + ": is coloured; how bright its colours are is taken");
  }
  if (pixels.opacity.size() == 0) return brightness;
  for (Eigen::Index i = 0; i < brightness.pixels.size(); ++i) {
    brightness.pixels(i) = over_black(brightness.pixels(i), pixels.opacity(i));
  }
  if (pixels.opacities_differ) {
    brightness.notes.push_back(name +
                               ": is transparent in places, which count as if they lay on black");
  }
  return brightness;
}

namespace {

/// Running mean. If all values are equal, the mean equals them bit by bit.
struct RunningMean {
  double value = 0;
  int count = 0;

  void add(double more) { value += (more - value) / ++count; }
};

/// Throws if the mesh has no texture coordinates, or one that is not finite.
void check_texture(const std::string& path, const Connectivity& mesh, const std::string& name) {
  const TextureCoordinates& texture = mesh.texture;
  if (texture.coordinates.empty()) {
    throw MismatchError(path +
                        ": the mesh has no texture coordinates at which a picture could be looked "
                        "up; paint a vertex field or list weights of vertices, or name a source "
                        "whose files hold texture coordinates");
  }
  for (std::size_t corner = 0; corner < texture.corners.size(); ++corner) {
    if (texture.corners[corner] < 0) continue;
    const Eigen::Vector2d& uv =
        texture.coordinates[static_cast<std::size_t>(texture.corners[corner])];
    if (uv.allFinite()) continue;
    throw IoError(name, "texture coordinate " + std::to_string(texture.corners[corner]) +
                            " (from 0), of vertex " +
                            std::to_string(mesh.polygons.corners[corner]) + ", is (" +
                            readable(uv.x()) + ", " + readable(uv.y()) + "), at which " + path +
                            " cannot be looked up; expected finite numbers");
  }
}

/// Warnings that the picture may be the wrong one for some faces: other tiles or materials may have
/// their own pictures.
std::vector<std::string> notes_on_texture(const std::string& path, const Connectivity& mesh) {
  std::vector<std::string> notes;
  const auto beyond =
      std::ranges::count_if(mesh.texture.coordinates, [](const Eigen::Vector2d& uv) {
        return uv.allFinite() && Brightness::is_beyond(uv.x(), uv.y());
      });
  if (beyond > 0) {
    notes.push_back(path + ": " + std::to_string(beyond) + " of " +
                    std::to_string(mesh.texture.coordinates.size()) +
                    " texture coordinates lie outside [0, 1], where the picture is repeated, also "
                    "where tiles (UDIM) have pictures of their own");
  }
  std::vector<std::string> materials;
  for (const NamedFaces& of_material : named_faces(mesh, FaceGroupKind::material)) {
    materials.push_back(of_material.name);
  }
  if (materials.size() > 1) {
    notes.push_back(path + ": is looked up for all materials of the mesh, " + listed(materials) +
                    ", also where they have pictures of their own");
  }
  return notes;
}

Painting painting_of_picture(const std::string& path, const Connectivity& mesh,
                             const std::string& mesh_name) {
  Brightness picture = read_brightness(path);
  check_texture(path, mesh, mesh_name);
  const TextureCoordinates& texture = mesh.texture;
  std::vector<std::optional<double>> known(texture.coordinates.size());
  std::vector<RunningMean> means(mesh.vertices);
  for (std::size_t corner = 0; corner < texture.corners.size(); ++corner) {
    if (texture.corners[corner] < 0) continue;
    const auto index = static_cast<std::size_t>(texture.corners[corner]);
    if (!known[index]) {
      const Eigen::Vector2d& uv = texture.coordinates[index];
      known[index] = picture.at(uv.x(), uv.y());
    }
    means[mesh.polygons.corners[corner]].add(*known[index]);
  }
  Painting painting{Eigen::VectorXd::Zero(mesh.vertices), std::move(picture.notes)};
  for (int v = 0; v < mesh.vertices; ++v) painting.weights[v] = means[v].value;
  std::ranges::move(notes_on_texture(path, mesh), std::back_inserter(painting.notes));
  const auto bare = std::ranges::count(means, 0, &RunningMean::count);
  if (bare > 0) {
    painting.notes.push_back(path + ": " + std::to_string(bare) +
                             " vertices have no texture coordinates and take nothing of the "
                             "motion");
  }
  return painting;
}

Eigen::VectorXd weights_of_list(const std::string& path, int vertices) {
  const std::string text = read_file(path);
  TextCursor cursor(path, without_byte_order_mark(text), {.comments = true});
  std::vector<double> weights;
  for (auto word = cursor.word_anywhere(); !word.empty(); word = cursor.word_anywhere()) {
    weights.push_back(cursor.number(word, "a weight"));
  }
  if (weights.size() != static_cast<std::size_t>(vertices)) {
    throw MismatchError(path + ": weights of " + std::to_string(weights.size()) +
                        " vertices, expected " + std::to_string(vertices) + " as in the source");
  }
  return Eigen::Map<const Eigen::VectorXd>(weights.data(), vertices);
}

Eigen::VectorXd weights_of_table(const std::string& path, int vertices) {
  CsvReader reader(path);
  if (reader.names() != std::vector<std::string_view>{"vertex", "weight"}) {
    reader.fail("expected the columns vertex,weight");
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(vertices);
  std::vector<bool> is_known(vertices, false);
  while (reader.next_row()) {
    const double number = reader.number(0);
    if (number != std::floor(number)) {
      reader.fail("expected a vertex, found " + std::string(reader.field(0)));
    }
    if (!(number >= 0 && number < vertices)) {
      throw MismatchError(path + ": vertex " + std::string(reader.field(0)) +
                          "; the mesh has vertices 0 to " + std::to_string(vertices - 1));
    }
    const auto vertex = static_cast<VertexIndex>(number);
    if (is_known[vertex]) reader.fail("vertex " + std::to_string(vertex) + " occurs twice");
    is_known[vertex] = true;
    weights[vertex] = reader.number(1);
  }
  return weights;
}

/// Suggestion about the likely unit of weights that exceed 1.
std::string other_unit(const Eigen::VectorXd& weights) {
  constexpr double kPercent = 100, kByte = 255;
  if (!weights.allFinite() || weights.minCoeff() < 0) return "";
  if (weights.maxCoeff() <= kPercent) return "; divide them by 100 if they are in percent";
  if (weights.maxCoeff() <= kByte) return "; divide them by 255 if they are a picture's";
  return "";
}

}  // namespace

Painting read_painting(const std::filesystem::path& path, const Connectivity& mesh,
                       const std::string& mesh_name) {
  const std::string name = path.string(), extension = lower_extension(path);
  Painting painting;
  if (std::ranges::find(kPictures, extension) != kPictures.end()) {
    painting = painting_of_picture(name, mesh, mesh_name);
  } else if (extension == ".txt") {
    painting.weights = weights_of_list(name, mesh.vertices);
  } else if (extension == ".csv") {
    painting.weights = weights_of_table(name, mesh.vertices);
  } else {
    throw IoError(name, "expected a painting in " + joined(kPictures, ", ") + ", .csv or .txt");
  }
  check_painting(name, painting.weights);
  return painting;
}

void check_painting(const std::string& name, const Eigen::VectorXd& weights) {
  for (Eigen::Index v = 0; v < weights.size(); ++v) {
    if (weights[v] >= 0 && weights[v] <= 1) continue;
    throw IoError(name, "vertex " + std::to_string(v) + " has the weight " + readable(weights[v]) +
                            ", expected 0 to 1" + other_unit(weights));
  }
  if (!(weights.array() > 0).any()) {
    throw IoError(name, "no vertex has a weight above 0, so that nothing would move; paint some");
  }
}

}  // namespace mimetra
