#include "toolkit/model/expression_notes.h"

#include <map>

#include "toolkit/mesh/text.h"
#include "toolkit/model/displaced_expressions.h"
#include "toolkit/model/exchanged_sides.h"
#include "toolkit/model/expression_names.h"
#include "toolkit/model/torn_expressions.h"

namespace mimetra {

namespace {

std::string described(const ExchangedSides& sides) {
  const std::string these = listed(sides.left_halves);
  if (sides.everywhere) {
    return "expressions of the left move the face's right: " + these +
           "; the face is mirrored, as by an export with one axis negated, or left is the "
           "viewer's: "
           "on another face, left and right would be exchanged";
  }
  return "expressions of the left move the side that the others call right: " + these +
         "; exchange them with their other halves";
}

/// Expressions that are the same but for how they are written: "'a_L' and 'aLeft'".
std::vector<std::string> written_twice(const std::vector<std::string>& names) {
  std::map<std::string, std::string> first;
  std::vector<std::string> twice;
  for (const std::string& name : names) {
    const auto [known, is_new] = first.try_emplace(folded_name(spelled_out(name)), name);
    if (!is_new) twice.push_back("'" + known->second + "' and '" + name + "'");
  }
  return twice;
}

}  // namespace

std::vector<std::string> notes_on_expressions(const std::string& name, const Positions& neutral,
                                              const Triangles& triangles,
                                              const ShapeBasis& expressions) {
  std::vector<std::string> notes;
  const std::vector<std::string> displaced = displaced_expressions(neutral, triangles, expressions);
  if (!displaced.empty()) {
    notes.push_back(name + ": expressions of another place, turn or size than the neutral: " +
                    listed(displaced) +
                    "; every vertex of it moves as in no expression: bring them there (`mimetra "
                    "align`) and into one unit, or the face moves with them");
  }
  const std::vector<std::string> torn = torn_expressions(neutral, triangles, expressions);
  if (!torn.empty()) {
    notes.push_back(name +
                    ": expressions that tear the neutral's surface, as where their vertices "
                    "are in another order: " +
                    listed(torn) + "; give them the neutral's (`mimetra convert --match`)");
  }
  const std::vector<std::string> twice = written_twice(expressions.names);
  if (!twice.empty()) {
    notes.push_back(name + ": expressions that differ in how they are written only: " +
                    listed(twice) + "; weights with a column for one of them drive both");
  }
  const ExchangedSides sides = exchanged_sides(neutral, triangles, expressions);
  if (!sides.left_halves.empty()) notes.push_back(name + ": " + described(sides));
  return notes;
}

}  // namespace mimetra
