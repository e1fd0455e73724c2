#include "toolkit/mesh/option.h"

#include <cmath>

#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

std::string text_of(const Range& range) {
  if (range.minimum && range.maximum) {
    return "from " + readable(*range.minimum) + " to " + readable(*range.maximum);
  }
  if (range.minimum) return "at least " + readable(*range.minimum);
  if (range.maximum) return "at most " + readable(*range.maximum);
  return "finite";
}

}  // namespace

bool Range::holds(double number) const {
  return std::isfinite(number) && (!minimum || number >= *minimum) &&
         (!maximum || number <= *maximum);
}

void check_number(std::string_view name, const Range& range, double number) {
  if (range.holds(number)) return;
  throw std::invalid_argument(std::string(name) + " is " + readable(number) + "; it must be " +
                              text_of(range));
}

void check_length(std::string_view name, const Range& range, const Length& length) {
  Range allowed = {range.minimum.value_or(0), range.maximum};
  if (!length.absolute) allowed.maximum = range.maximum.value_or(Length::kLargestShare);
  check_number(name, allowed, length.value);
}

}  // namespace mimetra
