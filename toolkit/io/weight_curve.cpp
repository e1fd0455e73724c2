#include "toolkit/io/weight_curve.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// The shorter of the intervals beside one of times that rise; infinite where it stands alone.
template <typename Times, typename Iterator>
double shorter_interval(const Times& times, Iterator at) {
  double shortest = std::numeric_limits<double>::infinity();
  if (at != times.begin()) shortest = *at - *std::prev(at);
  if (std::next(at) != times.end()) shortest = std::min(shortest, *std::next(at) - *at);
  return shortest;
}

/// Whether only rounding parts two times. Curves of one take may be resampled one by one.
/// `interval`: the shortest from either to the next key, in seconds.
bool is_same_time(double a, double b, double interval) {
  constexpr double kSeconds = 2e-6;
  constexpr double kSinglePrecision = 2.4e-7;  // relative: two units in the last place
  // Of an interval: in the evening, a unit in the last place is half a frame of 60 a second.
  constexpr double kShare = 0.01;
  const double rounding = std::max(kSeconds, kSinglePrecision * std::abs(a));
  return std::abs(a - b) <= std::min(rounding, kShare * interval);
}

/// Key number `key` of a curve and the part of the way to the next one.
struct KeyPlace {
  Eigen::Index key;
  double share;
};

KeyPlace key_place(const Eigen::VectorXd& times, double time) {
  const double* after = std::upper_bound(times.data(), times.data() + times.size(), time);
  const Eigen::Index next = after - times.data();
  const auto is_at = [&](Eigen::Index key) {
    return is_same_time(times[key], time, shorter_interval(times, times.begin() + key));
  };
  if (next > 0 && is_at(next - 1)) return {next - 1, 0};
  if (next == 0 || (next < times.size() && is_at(next))) return {next, 0};
  if (next == times.size()) return {next - 1, 0};
  return {next - 1, (time - times[next - 1]) / (times[next] - times[next - 1])};
}

/// How many equal steps between two keys show a curve no more coarsely than frames without times
/// are apart.
double steps_between(double key, double next) {
  // A third of a frame is no reason for another step: keys stand in single precision.
  constexpr double kAllowance = 1. / 3;
  return std::max(1., std::ceil((next - key) * kDefaultFramesPerSecond - kAllowance));
}

/// The keys of a curve, and times between those of splines, which move on a line nowhere. They
/// rise.
std::vector<double> shown_times(const std::string& path, const WeightCurve& curve) {
  const Eigen::VectorXd& keys = curve.times;
  std::vector<double> times(keys.begin(), keys.end());
  if (curve.between != WeightCurve::Between::cubic || times.empty()) return times;
  double most = 0;
  for (Eigen::Index k = 1; k < keys.size(); ++k) most += steps_between(keys[k - 1], keys[k]);
  constexpr double kMostFrames = 1e6;
  if (most > kMostFrames) {
    throw IoError(path, "an animation of weights on splines lasts " +
                            readable(keys[keys.size() - 1] - keys[0], 8) + " s; expected at most " +
                            readable(kMostFrames, 8) + " frames of it");
  }
  times.erase(times.begin() + 1, times.end());
  for (Eigen::Index k = 1; k < keys.size(); ++k) {
    const double steps = steps_between(keys[k - 1], keys[k]);
    for (double step = 1; step < steps; ++step) {
      times.push_back(keys[k - 1] + step / steps * (keys[k] - keys[k - 1]));
    }
    times.push_back(keys[k]);
  }
  return times;
}

/// A frame before each jump of a curve on steps, until which it stays, unless there is one.
void add_times_before_jumps(const WeightCurve& curve, std::set<double>& times) {
  constexpr double kLongestFrame = 1. / 20;  // of other curves
  const Eigen::VectorXd& keys = curve.times;
  for (Eigen::Index k = 1; k < keys.size(); ++k) {
    const double steps = steps_between(keys[k - 1], keys[k]);
    if (steps < 2 || curve.values.row(k) == curve.values.row(k - 1)) continue;
    const auto next = times.lower_bound(keys[k] - kLongestFrame);
    const bool has_frame = next != times.end() && *next < keys[k] && key_place(keys, *next).key < k;
    if (!has_frame) times.insert(keys[k] - (keys[k] - keys[k - 1]) / steps);
  }
}

}  // namespace

bool WeightCurve::is_still() const {
  const bool is_level = between != Between::cubic || (slopes_in.isZero(0) && slopes_out.isZero(0));
  return is_level && (values.rowwise() - values.row(0)).isZero(0);
}

Eigen::RowVectorXd WeightCurve::at(double time) const {
  if (times.size() == 0) return values.row(0);
  const auto [key, share] = key_place(times, time);
  if (share == 0 || between == Between::step) return values.row(key);
  if (between == Between::linear) {
    return (1 - share) * values.row(key) + share * values.row(key + 1);
  }
  // Hermite's polynomials. [glTF 2.0, appendix C.5]
  const double step = times[key + 1] - times[key];
  const double square = share * share, cube = square * share;
  return (2 * cube - 3 * square + 1) * values.row(key) +
         step * (cube - 2 * square + share) * slopes_out.row(key) +
         (3 * square - 2 * cube) * values.row(key + 1) +
         step * (cube - square) * slopes_in.row(key + 1);
}

Eigen::VectorXd shown_times(const std::string& path,
                            const std::vector<const WeightCurve*>& curves) {
  std::set<double> times;
  for (const WeightCurve* curve : curves) {
    const std::vector<double> own = shown_times(path, *curve);
    std::vector<double> added;
    for (auto time = own.begin(); time != own.end(); ++time) {
      const double interval = shorter_interval(own, time);
      const auto is_it = [&](std::set<double>::const_iterator known) {
        return is_same_time(*known, *time, std::min(interval, shorter_interval(times, known)));
      };
      const auto next = times.lower_bound(*time);
      const bool is_known =
          (next != times.end() && is_it(next)) || (next != times.begin() && is_it(std::prev(next)));
      if (!is_known) added.push_back(*time);
    }
    times.insert(added.begin(), added.end());
  }
  for (const WeightCurve* curve : curves) {
    if (curve->between == WeightCurve::Between::step) add_times_before_jumps(*curve, times);
  }
  Eigen::VectorXd all(static_cast<Eigen::Index>(times.size()));
  std::copy(times.begin(), times.end(), all.begin());
  return all;
}

}  // namespace mimetra
