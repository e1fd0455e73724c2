#pragma once

#include <chrono>
#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace mimetra {

/// JSON with its keys in the order they were added.
using Json = nlohmann::ordered_json;

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// `value` with `digits` significant digits, as people read it.
std::string readable(double value, int digits = 4);

/// A share as a percentage: 0.1234 is "12.3 %".
std::string percent(double share);

/// The part `done` of `progress`: a caller's [0, 1] becomes [from, to] of the whole.
std::function<bool(double)> part_of(const std::function<bool(double)>& progress, double from,
                                    double to);

}  // namespace mimetra
