#include "toolkit/operations/reports.h"

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "toolkit/formats/gltf/scene.h"
#include "toolkit/io/format.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"
#include "toolkit/operations/weight_tables.h"

namespace mimetra {

std::string report_with(const Json& report, const std::string& name, std::size_t count,
                        const std::function<std::string(std::size_t)>& text_of) {
  std::string text = json_text(report);
  text.back() = ',';
  text += json_text(name) + ":[";
  for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? "," : "") + text_of(i);
  return text + "]}";
}

double seconds(const FrameSource& sequence) {
  return sequence.times()[sequence.frames() - 1] - sequence.times()[0];
}

std::string times_text(const FrameSource& sequence) {
  const Eigen::VectorXd& times = sequence.times();
  std::string text = readable(times[0]) + " to " + readable(times[times.size() - 1]) + " s";
  if (sequence.times_are_known()) return text;
  return text + " if there are " + readable(kDefaultFramesPerSecond) +
         " per second: the input says nothing of time";
}

void warn_of_guessed_rate(const Invocation& invocation, const std::string& name,
                          bool times_are_known) {
  if (times_are_known || invocation.parameters.number("smoothness") == 0) return;
  invocation.warn(name + ": says nothing of time, so that --smoothness takes its frames for " +
                  readable(kDefaultFramesPerSecond) + " a second; --fps tells how many there are");
}

void warn_of_lost_expressions(const Invocation& invocation, const FrameSource& frames,
                              KeptInScenes kept) {
  const auto* animation = dynamic_cast<const Animation*>(&frames);
  const auto paths = invocation.wanted.find("out");
  if (!animation || animation->model().expressions().size() == 0 || animation->frames() > 1 ||
      !animation->weights().isZero(0) || paths == invocation.wanted.end() ||
      paths->second.empty()) {
    return;
  }
  const std::filesystem::path& path = paths->second.front();
  const bool is_one_mesh = is_mesh_extension(path.extension().string());
  const bool holds_them = kept == KeptInScenes::yes && is_scene_file(path);
  if (is_one_mesh || holds_them || is_weight_file(path.string())) return;
  invocation.warn(path.string() + ": holds the neutral alone, not the " +
                  counted(animation->model().expressions().size(), "expression") +
                  " of the model; " + (kept == KeptInScenes::yes ? "a .glb holds them, and " : "") +
                  "--weights moves them");
}

Json json_of(const HeadMotionTaken& motion) {
  Json json = {{"align", motion.how},
               {"reason", motion.why},
               {"largest_rotation_degrees", motion.angle},
               {"largest_translation", motion.shift}};
  if (motion.stillest) json["stillest_vertices_share_of_size"] = *motion.stillest;
  if (motion.disagreement) {
    json["disagreement_degrees"] = *motion.disagreement;
    json["uncertain"] = motion.is_uncertain();
  }
  if (motion.held_out) {
    json["held_out"] = {{"stable", motion.held_out->stable}, {"joint", motion.held_out->joint}};
  }
  return json;
}

void add_convergence(Json& report, const Components& components) {
  if (components.converged) report["converged"] = *components.converged;
  if (components.iteration > 0) report["iteration"] = components.iteration;
}

std::string convergence_text(const Components& components) {
  const auto ran = static_cast<int>(components.energies.size());
  std::string text =
      counted(ran, "iteration") + ", " + (*components.converged ? "converged" : "not converged");
  if (components.iteration == ran) return text;
  return text + ", the best was number " + std::to_string(components.iteration);
}

namespace {

Json known_share(double share, bool is_known) {
  return is_known ? Json(share) : Json(nullptr);
}

Json report_of(const Region& region, bool energy_is_known) {
  Json json = {{"center", region.center},
               {"radius", region.radius},
               {"vertices", region.vertices.size()},
               {"energy_share", known_share(region.energy_share, energy_is_known)},
               {"component", region.component}};
  if (region.surface_part >= 0) {
    json["surface_component"] = region.surface_part;
    json["surface_share"] = region.surface_share;
  }
  if (!region.added_for.empty()) json["added_for"] = region.added_for;
  return json;
}

}  // namespace

Json added_regions(const Regions& regions) {
  Json list = Json::array();
  for (const Region& region : regions.regions) {
    if (!region.added_for.empty()) {
      list.push_back(report_of(region, regions.energy_is_known()));
    }
  }
  return list;
}

Json report_of(const Regions& regions) {
  Json list = Json::array();
  for (const Region& region : regions.regions) {
    list.push_back(report_of(region, regions.energy_is_known()));
  }
  return {{"regions", list},
          {"vertices", regions.vertex_count()},
          {"triangles", regions.triangles.size()},
          {"vertex_share", regions.vertex_share()},
          {"triangle_share", regions.triangle_share()},
          {"energy_share", known_share(regions.energy_share, regions.energy_is_known())},
          {"notes", regions.notes}};
}

std::string summary_of(const Regions& regions) {
  const std::string vertices = counted(regions.vertex_count(), "vertex", "vertices") + " (" +
                               percent(regions.vertex_share()) + ")";
  const std::string triangles = counted(std::ssize(regions.triangles), "triangle") + " (" +
                                percent(regions.triangle_share()) + ")";
  const std::string hold = regions.regions.size() == 1 ? " holds " : " hold ";
  return counted(std::ssize(regions.regions), "region") + hold + vertices +
         (regions.energy_is_known()
              ? ", " + triangles + " and " + percent(regions.energy_share) + " of the motion energy"
              : " and " + triangles) +
         "\n";
}

Json json_of(const MatchReport& match) {
  const CorrespondenceQuality& quality = match.quality;
  Json json = {{"verdict", quality.verdict()},
               {"without_partner", quality.without_partner},
               {"mean_residual", quality.mean_residual},
               {"largest_residual", quality.largest_residual},
               {"seconds", match.seconds}};
  if (match.markers > 0) {
    json["markers"] = match.markers;
    json["markers_found"] = match.found.has_value();
    json["folded"] = quality.folded;
  }
  return json;
}

std::string summary_of(const MatchReport& match) {
  const std::string verdict = match.quality.verdict();
  return (match.found ? std::to_string(match.markers) + " markers found, " : "") +
         "correspondence " + verdict.substr(0, verdict.find(':')) + ", " +
         percent(1 - match.quality.without_partner) + " of the triangles paired, " +
         readable(match.seconds) + " s";
}

Json json_of(const std::vector<ComparedOpening>& openings) {
  Json list = Json::array();
  for (const ComparedOpening& opening : openings) {
    list.push_back({{"name", opening.name},
                    {"source", {opening.source_least, opening.source_most}},
                    {"target", {opening.target_least, opening.target_most}},
                    {"mean_difference", opening.difference}});
  }
  return list;
}

std::string summary_of(const std::vector<ComparedOpening>& openings) {
  std::vector<std::string> parts;
  parts.reserve(openings.size());
  for (const ComparedOpening& opening : openings) {
    parts.push_back(std::string(opening.name) + ' ' + percent(opening.source_least) + " to " +
                    percent(opening.source_most) + " on the source, " +
                    percent(opening.target_least) + " to " + percent(opening.target_most) +
                    " here");
  }
  return parts.empty() ? "" : "  open, of their width: " + joined(parts, "; ", "; ") + '\n';
}

std::vector<Field> fields_of(const Correspondence& pairs) {
  const int triangles = pairs.target_triangles();
  Field residual{"match_residual", Field::Location::triangles, Eigen::MatrixXd(triangles, 1)};
  Field partners{"match_partners", Field::Location::triangles, Eigen::MatrixXd(triangles, 1), true};
  for (int t = 0; t < triangles; ++t) {
    residual.values(t, 0) = std::isfinite(pairs.residuals[t]) ? pairs.residuals[t] : 0;
    partners.values(t, 0) = pairs.offsets[t + 1] - pairs.offsets[t];
  }
  return {residual, partners};
}

Table table_of(const std::vector<EvaluationRow>& rows) {
  Table table;
  table.columns = {"k",
                   "vertices",
                   "triangles",
                   "vertex_share",
                   "triangle_share",
                   "radius",
                   "de_all",
                   "de_region",
                   "mpe_all",
                   "mpe_region",
                   "decompose_seconds",
                   "transfer_seconds",
                   "converged",
                   "leak",
                   "crease",
                   "largest_crease"};
  table.word_column = "by";
  table.picture = {"triangle_share",        "de_all",
                   "Error against regions", "share of the triangles",
                   "DE (length squared)",   "all triangles"};
  for (const EvaluationRow& row : rows) {
    table.words.emplace_back(row.by ? choice_name(*row.by) : "");
    table.rows.push_back({row.k ? std::optional<double>(*row.k) : std::nullopt,
                          double(row.vertices), double(row.triangles), row.vertex_share,
                          row.triangle_share, row.radius, row.de_all, row.de_region, row.mpe_all,
                          row.mpe_region, row.decompose_seconds, row.transfer_seconds,
                          row.converged ? std::optional<double>(*row.converged) : std::nullopt,
                          row.leak, row.crease, row.largest_crease});
  }
  return table;
}

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
