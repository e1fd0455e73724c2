#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/mesh_codecs.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/temporary_name.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// The shortest digits that read back equal, to where `text` has room for them.
template <typename Number>
char* put_shortest(char* text, Number value) {
  return std::to_chars(text, text + kMostDigits, value).ptr;
}

}  // namespace

MeshFileWriter::MeshFileWriter(const Connectivity& connectivity, const std::string& extension,
                               bool double_precision, const std::vector<Field>& fields,
                               const std::string& name, const Context& context)
    : vertices_(connectivity.vertices),
      single_precision_(!double_precision || lower_case(extension) == ".stl") {
  constexpr double kFrameShare = 0.9;
  const MeshCodec* codec = mesh_codec(extension);
  if (!codec) throw std::invalid_argument(unknown_mesh_extension(lower_case(extension)));
  try {
    MeshFrame frame = codec->frame(connectivity, double_precision, context.part(0, kFrameShare));
    if (codec->properties) {
      frame.after += codec->properties(fields, connectivity, context.part(kFrameShare, 1));
    }
    frame_ = std::make_unique<const MeshFrame>(std::move(frame));
  } catch (const MismatchError& error) {
    throw MismatchError(name + ": " + error.what());
  }
}

MeshFileWriter::~MeshFileWriter() = default;

void MeshFileWriter::write(const fs::path& path, const PositionsView& positions) const {
  if (positions.rows() != vertices_) {
    throw std::invalid_argument(std::to_string(positions.rows()) + " positions, expected " +
                                std::to_string(vertices_) + " as the faces have");
  }
  Eigen::Index vertex = 0, axis = 0;
  const double farthest = vertices_ == 0 ? 0 : positions.cwiseAbs().maxCoeff(&vertex, &axis);
  // What is infinite already stays so.
  if (single_precision_ && farthest > kLargestSingle && std::isfinite(farthest)) {
    throw MismatchError(committed_name(path).string() + ": " + beyond_single(vertex, farthest));
  }
  const std::string between = frame_->positions(positions);
  OutputFile file(path);
  file.write({frame_->before, between, frame_->after});
  file.close();
}

void write_mesh(const fs::path& path, const PositionsView& positions,
                const Connectivity& connectivity, const MeshWriteOptions& options,
                const Context& context) {
  check_options(options);
  context.report(0);
  const std::string extension =
      lower_case(options.extension.empty() ? path.extension().string() : options.extension);
  if (!is_mesh_extension(extension)) {
    throw OutputError(path.string(), unknown_mesh_extension(extension));
  }
  MeshFileWriter(connectivity, extension, options.double_precision, options.fields,
                 committed_name(path).string(), context)
      .write(path, positions);
}

void write_mesh(const fs::path& path, const TriMesh& mesh, const MeshWriteOptions& options,
                const Context& context) {
  write_mesh(path, PositionsView(mesh.positions.data(), mesh.positions.rows(), 3),
             mesh.connectivity, options, context);
}

char* put_number(char* text, double value, bool double_precision) {
  return double_precision ? put_shortest(text, value)
                          : put_shortest(text, static_cast<float>(value));
}

void append_number(std::string& text, double value, bool double_precision) {
  std::array<char, kMostDigits> digits;
  text.append(digits.data(), put_number(digits.data(), value, double_precision));
}

void append_integer(std::string& text, long long value) {
  std::array<char, kMostDigits> digits;
  text.append(digits.data(), put_shortest(digits.data(), value));
}

bool fits_single_precision(const TextureCoordinates& texture) {
  return std::ranges::all_of(texture.coordinates, [](const Eigen::Vector2d& uv) {
    const double farthest = uv.cwiseAbs().maxCoeff();
    return farthest <= kLargestSingle || !std::isfinite(farthest);
  });
}

std::string position_lines(std::string_view before, const PositionsView& positions,
                           bool double_precision) {
  const std::size_t longest = before.size() + 3 * (kMostDigits + 1);
  std::string text(longest * static_cast<std::size_t>(positions.rows()), ' ');
  char* at = text.data();
  for (Eigen::Index vertex = 0; vertex < positions.rows(); ++vertex) {
    at = std::copy(before.begin(), before.end(), at);
    for (int axis = 0; axis < 3; ++axis) {
      at = put_number(at, positions(vertex, axis), double_precision);
      *at++ = axis < 2 ? ' ' : '\n';
    }
  }
  text.resize(static_cast<std::size_t>(at - text.data()));
  return text;
}

}  // namespace mimetra
