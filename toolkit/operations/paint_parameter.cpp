#include "toolkit/operations/paint_parameter.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/painting_file.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/pipeline_parameters.h"

namespace mimetra {

namespace {

constexpr std::string_view kField = "field:";

/// Names of fields with one number per vertex.
std::vector<std::string> scalar_fields(const std::vector<Field>& fields) {
  std::vector<std::string> names;
  for (const Field& field : fields) {
    const bool is_scalar = field.location == Field::Location::vertices && field.values.cols() == 1;
    if (is_scalar) names.push_back(field.name);
  }
  return names;
}

/// Reads the weights from a field of the sequence.
Painting painting_of_field(const std::string& name, const NamedData& source) {
  const std::vector<Field>& fields = std::get<FieldSequence>(source.data).fields;
  const std::string place = source.name + ": field '" + name + "'";
  const auto found = std::ranges::find_if(fields, [&name](const Field& field) {
    return field.name == name && field.location == Field::Location::vertices;
  });
  if (found == fields.end()) {
    const bool on_triangles = std::ranges::find(fields, name, &Field::name) != fields.end();
    const std::vector<std::string> known = scalar_fields(fields);
    throw MismatchError(
        place + (on_triangles ? " lies on triangles, expected one on vertices" : " is not there") +
        (known.empty() ? "; the sequence has none that could be painted"
                       : "; there are " + listed(known) + suggestion_for(name, known)));
  }
  if (found->values.cols() != 1) {
    throw MismatchError(place + " holds " + std::to_string(found->values.cols()) +
                        " numbers for each vertex, expected one");
  }
  Painting painting{found->values.col(0)};
  check_painting(place, painting.weights);
  return painting;
}

Painting painting_of(const std::string& text, const NamedData& source) {
  if (text.starts_with(kField)) return painting_of_field(text.substr(kField.size()), source);
  return read_painting(text, std::get<FieldSequence>(source.data).frames->connectivity(),
                       source.name);
}

}  // namespace

Parameter paint_parameter() {
  return {"paint",
          ParameterKind::file,
          {},
          "regions as somebody painted them: how much of the motion each vertex of the source "
          "takes, 0 to 1; a vertex field, a picture in the source's texture space (.png or .jpg, "
          "black to white), a number for each vertex (.txt) or columns vertex,weight (.csv)",
          "",
          {},
          {},
          {std::string(kField) + "NAME"},
          false,
          kRegionGroup,
          "regions as painted: a field, a picture or a list"};
}

std::vector<Exclusion> paint_exclusions() {
  return {{concatenated<std::string>(
               {{"full", "k", "curve", "select", "triangles", "only", "without", "radius", "rest"},
                options_of_energy()}),
           {"paint"},
           "the regions are those of --paint"},
          {{"regions", "components"},
           {"paint"},
           "the regions are those of --paint; leave one of them out"},
          {{"components-out"}, {"paint"}, "there are no components with --paint"},
          {{"per-region"},
           {"paint"},
           "weights of each region move the whole face, and --paint says how much of the motion "
           "each vertex takes; name hard regions instead, --regions"}};
}

std::optional<GivenRegions> painted_region_of(const Invocation& invocation) {
  const auto text = invocation.parameters.optional_text("paint");
  if (!text) return {};
  const NamedData& source = invocation.input("source");
  Painting painting = painting_of(*text, source);
  for (const std::string& note : painting.notes) invocation.warn(note);
  constexpr double kFaint = 0.1;
  if (const double most = painting.weights.maxCoeff(); most < kFaint) {
    invocation.warn(*text + ": the largest weight is " + readable(most) + ", so that at most " +
                    percent(most) + " of the motion is taken; expected weights up to 1");
  }
  const Triangles& triangles = std::get<FieldSequence>(source.data).frames->triangles();
  return GivenRegions{*text, painted_region(painting.weights, triangles)};
}

Json weights_report(const Eigen::VectorXd& weights, const Parameters& parameters,
                    const std::optional<Length>& falloff) {
  const std::optional<std::string> paint = parameters.optional_text("paint");
  const auto ones = (weights.array() == 1).count(), zeros = (weights.array() == 0).count();
  return {{"paint", paint ? Json(*paint) : Json(nullptr)},
          {"falloff", falloff ? Json(to_text(*falloff)) : Json(nullptr)},
          {"one", ones},
          {"between", weights.size() - ones - zeros},
          {"zero", zeros}};
}

}  // namespace mimetra
