#include "toolkit/pipeline/given_markers.h"

#include "toolkit/correspondence/marker_check.h"

namespace mimetra {

namespace {

/// By how much lower or higher vertices the markers would fit much better; 0 where they are right.
int better_shift(const std::vector<Marker>& markers, const TriMesh& source, const TriMesh& target) {
  for (const int shift : {1, -1}) {
    if (fit_better_shifted(markers, shift, source.positions, target.positions)) return shift;
  }
  return 0;
}

std::string described_shift(int shift) {
  return std::string("the markers fit much better as vertices one ") +
         (shift > 0 ? "lower: they are counted from 1" : "higher: they are counted from 0");
}

}  // namespace

void check_given_markers(const std::vector<Marker>& markers, const std::vector<std::string>& places,
                         const TriMesh& source, const TriMesh& target, const std::string& name,
                         const Context& context) {
  const int shift = better_shift(markers, source, target);
  try {
    check_markers(markers, source.positions, target.positions);
    // Throws where they fit a mirror image only.
    is_inside_out(source, target, markers);
  } catch (const MismatchError& error) {
    const std::string text = name + ": " + error.what();
    if (shift == 0) throw MismatchError(text);
    throw OptionError(Topic::shifted_markers, text + "; " + described_shift(shift));
  }
  if (shift != 0) {
    throw OptionError(Topic::shifted_markers, name + ": " + described_shift(shift));
  }
  const auto doubtful = doubtful_markers(markers, source.positions, target.positions);
  for (const std::string& text : described(doubtful, markers, places)) {
    context.note(name + ": " + text, Topic::poor_match);
  }
}

}  // namespace mimetra
