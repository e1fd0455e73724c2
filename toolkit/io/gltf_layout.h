#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"

/// Internal to the writer of glTF.
namespace mimetra {

inline constexpr int kFloatType = 5126, kIndexType = 5125;
inline constexpr int kVertexData = 34962, kFaceData = 34963;

/// Smallest and largest x, y and z.
using GltfBounds = std::array<std::array<double, 3>, 2>;

/// As long as a bound can get as text, to keep room for it.
inline constexpr double kLongestNumber = -std::numeric_limits<double>::min();
inline constexpr GltfBounds kUnknownBounds = {{{kLongestNumber, kLongestNumber, kLongestNumber},
                                               {kLongestNumber, kLongestNumber, kLongestNumber}}};

/// Bounds that hold a point too; those of the first point (0) alone.
void include(GltfBounds& bounds, Eigen::Index point, const float* xyz);

/// What stands where in the file, told before it is written.
class GltfLayout {
 public:
  /// Room for `bytes` bytes. Returns the view.
  std::size_t add_view(std::size_t bytes, int use = 0) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}};
    if (use != 0) view["target"] = use;
    views_.push_back(std::move(view));
    bytes_ += bytes;
    return views_.size() - 1;
  }

  /// Elements that fill a view.
  std::size_t add(std::size_t view, int type, const char* shape, std::size_t count) {
    accessors_.push_back(
        {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
    return accessors_.size() - 1;
  }
  /// The same of numbers in single precision of which only some are not 0.
  std::size_t add_sparse(const char* shape, std::size_t count, std::size_t stored,
                         std::size_t indices, std::size_t values) {
    accessors_.push_back({{"componentType", kFloatType},
                          {"count", count},
                          {"type", shape},
                          {"sparse",
                           {{"count", stored},
                            {"indices", {{"bufferView", indices}, {"componentType", kIndexType}}},
                            {"values", {{"bufferView", values}}}}}});
    return accessors_.size() - 1;
  }
  void set_bounds(std::size_t accessor, const GltfBounds& bounds) {
    accessors_[accessor]["min"] = bounds[0];
    accessors_[accessor]["max"] = bounds[1];
  }
  void set_bounds(std::size_t accessor, double least, double most) {
    accessors_[accessor]["min"] = {least};
    accessors_[accessor]["max"] = {most};
  }

  std::size_t bytes() const { return bytes_; }
  std::size_t offset(std::size_t view) const {
    return views_[view]["byteOffset"].get<std::size_t>();
  }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  Json views_ = Json::array(), accessors_ = Json::array();
  std::size_t bytes_ = 0;
};

/// `count` numbers in single precision.
std::string float_bytes(const double* values, Eigen::Index count);

/// Numbers of which those that are not 0 are stored, at least one.
struct SparseNumbers {
  std::string indices, values;
  std::size_t stored = 0;
};

/// `values` in elements of `size`; elements with `count / 2` or more that are not 0 give nothing.
std::optional<SparseNumbers> sparse_numbers(const double* values, Eigen::Index count, int size);

}  // namespace mimetra
