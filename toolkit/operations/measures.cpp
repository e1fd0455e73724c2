#include "toolkit/operations/measures.h"

namespace mimetra {

std::vector<Measure> decomposition_measures() {
  return {{"RMS error",
           "root mean square of what the components leave of the motion, over all coordinates; a "
           "length, and its share of the box diagonal"},
          {"KG error", "what they leave of the motion about its mean, percent"},
          {"displacements are zero",
           "the share of the components' displacement vectors that are exactly zero"}};
}

std::vector<Measure> region_measures() {
  return {{"vertices, triangles",
           "those that the regions hold; a triangle counts with one vertex in them"},
          {"motion energy",
           "the share of all squared displacements that is on vertices in the regions"}};
}

std::vector<Measure> transfer_measures() {
  return {{"DE",
           "deformation error: mean squared difference of the triangles' edges from what the "
           "source's deformation makes of the target's neutral, length squared; over all triangles "
           "it compares results by any regions, over those of the regions (in L) it does not"},
          {"leak", "the largest displacement of a vertex outside of the regions, a length"},
          {"crease",
           "how much more the surface bends at the border of the regions than the source asks for, "
           "degrees; seen from 3 on"},
          {"flipped",
           "triangles, over all frames, that turned by more than 90 degrees against where the "
           "source's deformation wants them"}};
}

std::vector<Measure> evaluation_measures() {
  std::vector<Measure> measures = transfer_measures();
  measures.push_back(
      {"MPE", "DE against that of the transfer by all triangles, percent; negative is worse"});
  return measures;
}

}  // namespace mimetra
