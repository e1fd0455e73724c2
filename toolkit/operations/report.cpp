#include <mimetra/operations/report.h>

#include <cstdio>

namespace mimetra {

std::string readable(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * share);
  return text;
}

std::function<bool(double)> part_of(const std::function<bool(double)>& progress, double from,
                                    double to) {
  if (!progress) return {};
  return [progress, from, to](double share) { return progress(from + share * (to - from)); };
}

}  // namespace mimetra
