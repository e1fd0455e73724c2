#include "toolkit/operations/option_words.h"

#include <string_view>
#include <vector>

#include "toolkit/mesh/text.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {

namespace {

/// Says how to make a crease at the regions' border less visible.
std::string softer_border(const Parameters& parameters) {
  if (parameters.is_set("falloff")) return "use a larger --falloff";
  if (parameters.is_set("paint")) return "paint a wider border, or let it fade by --falloff";
  std::vector<std::string> excluded;
  if (parameters.choice<Outside>("outside") == Outside::identity) {
    excluded.emplace_back("--outside identity");
  }
  if (parameters.is_set("triangles")) excluded.emplace_back("--triangles");
  const std::string without = excluded.empty() ? "" : " without " + joined(excluded, ", ", " and ");
  return "--falloff 0.3" + without + " lets the motion fade more softly";
}

/// Adds advice about the command's options to a text of the pipeline.
std::string in_command_terms(Topic topic, const std::string& text, const Parameters& parameters) {
  const std::string rest_option = parameters.find("source-rest") ? "--source-rest" : "--rest";
  switch (topic) {
    case Topic::other:
    case Topic::support_range:
      return text;
    case Topic::parting_vertices:
      return text + ", use --weld none to keep them apart";
    case Topic::unknown_neutral:
    case Topic::unneutral_rest:
      return text + "; give it with " + rest_option + " FILE";
    case Topic::other_rest:
      return text + "; give this face's with " + rest_option + " FILE, or take " + rest_option +
             " mean";
    case Topic::turning_head:
      return text + "; --align stable takes it out, --align none keeps it";
    case Topic::uncertain_motion:
      return text + (parameters.find("axes") ? "; --align joint finds it together with a target's "
                                               "expressions, --align none takes none out"
                                             : "; --align none takes none out");
    case Topic::joint_motion:
      return text + "; --align stable takes the stillest vertices, --align none takes none out";
    case Topic::no_joint_motion:
      return text + "; use --align stable";
    case Topic::poor_condition:
      if (!parameters.find("full")) return text;
      if (parameters.is_set("paint")) {
        return text + "; paint a wider border or more of the face, or use --full";
      }
      if (parameters.is_set("falloff") && !parameters.flag("per-region")) {
        return text + "; take a larger --falloff, more regions (-k, --radius) or --full instead";
      }
      return text + "; take more regions (-k, --radius) or --full";
    case Topic::completed_regions:
      return text + "; --complete 0 leaves them as they are";
    case Topic::completion_limit:
      return text + "; take more regions (-k, --radius), a larger --complete-limit or --full";
    case Topic::undetermined_axes:
      return text + "; use --axes none";
    case Topic::component_count:
      return "-k: " + text;
    case Topic::no_vertex_inside:
      return "--only, --without: " + text;
    case Topic::triangle_bound:
      return "--triangles: " + text + " (--radius)";
    case Topic::discs_beyond_bound:
      return text + "; a larger --triangles allows more";
    case Topic::few_discs:
      return text + "; a larger --radius makes larger discs";
    case Topic::no_selection:
      return text + "; use --select energy";
    case Topic::small_parts:
      return text +
             "; --only component:0 keeps to the largest, --without component:N leaves some out";
    case Topic::large_regions:
      return text + "; give lengths in the mesh's unit (--radius, --d-min and --d-max, as in 2abs)";
    case Topic::no_expressions:
      return text + "; use --space vertex";
    case Topic::no_pairs:
      return "--symmetry: " + text + "; name pairs in a file of --rules";
    case Topic::no_exclusives:
      return "--exclusive: " + text + "; name groups in a file of --rules";
    case Topic::anchor_vertex:
      return "--anchor: " + text;
    case Topic::held_anchor:
      return "--anchor: " + text + "; use --outside identity or --full";
    case Topic::anchor_and_weights:
      return "--anchor: " + text + "; use --full";
    case Topic::soft_outside:
      return "--outside: " + text + "; use --outside fixed";
    case Topic::visible_crease:
      return text + "; " + softer_border(parameters);
    case Topic::other_faces:
      if (!parameters.find("markers")) return text;
      return text +
             "; for another topology name at least four pairs of vertices that are the same "
             "point of the face (--markers FILE), or the --correspondence FILE of an earlier "
             "run";
    case Topic::shifted_markers:
      return text + "; use --index-base " + (parameters.integer("index-base") == 0 ? "1" : "0");
    case Topic::no_full_weight:
      return "--falloff: " + text + "; leave it out, or give some vertices the weight 1";
    case Topic::poor_match:
      return text;
  }
  return text;
}

}  // namespace

Context with_notes_as_warnings(const Invocation& invocation) {
  return invocation.context.with_notes(
      [parameters = invocation.parameters, log = invocation.log](const Note& note) {
        if (log) log(LogLevel::warning, in_command_terms(note.topic, note.text, parameters));
      });
}

void refuse(const OptionError& error, const Parameters& parameters) {
  const std::string text = in_command_terms(error.topic(), error.what(), parameters);
  switch (error.topic()) {
    case Topic::support_range:
      throw UsageError("--d-min: expected less than --d-max, found " + parameters.text("d-min") +
                       " and " + parameters.text("d-max"));
    case Topic::held_anchor:
    case Topic::anchor_and_weights:
    case Topic::soft_outside:
      throw UsageError(text);
    default:
      throw MismatchError(text);
  }
}

namespace {

constexpr std::string_view kQuoted = "option '";
/// Text before a word that the user typed, which keeps its spelling.
constexpr std::string_view kUnknown = "unknown option ";

bool is_of_a_name(char c) {
  return (c >= 'a' && c <= 'z') || c == '-';
}

/// Characters before an option's dashes.
bool parts_words(char c) {
  return std::string_view(" (,;:'").find(c) != std::string_view::npos;
}

struct Mention {
  std::size_t begin, end;
  std::string name;
};

std::size_t end_of_name(const std::string& text, std::size_t begin) {
  std::size_t at = begin;
  while (at < text.size() && (is_of_a_name(text[at]) || (at > begin && is_digit(text[at])))) ++at;
  return at;
}

/// Finds an option that `text` mentions at `begin`; the name is empty if there is none.
Mention mention_at(const std::string& text, std::size_t begin) {
  if (text.compare(begin, kQuoted.size(), kQuoted) == 0) {
    const std::size_t name = begin + kQuoted.size();
    const std::size_t end = end_of_name(text, name);
    if (end > name && end < text.size() && text[end] == '\'') {
      return {begin, end + 1, text.substr(name, end - name)};
    }
  }
  if (text[begin] != '-' || (begin > 0 && !parts_words(text[begin - 1]))) return {begin, begin, ""};
  const bool is_long = text.compare(begin, 2, "--") == 0;
  const std::size_t name = begin + (is_long ? 2 : 1);
  const std::size_t end = end_of_name(text, name);
  const bool is_named = end > name && text[name] != '-' && (is_long || end == name + 1);
  return {begin, end, is_named ? text.substr(name, end - name) : ""};
}

}  // namespace

std::string with_options_spelled(const std::string& message,
                                 const std::function<std::string(const std::string&)>& spelled) {
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const Mention mention = mention_at(message, at);
    if (mention.name.empty() || text.ends_with(kUnknown)) {
      text += message[at++];
    } else {
      text += spelled(mention.name == "force" ? "overwrite" : mention.name);
      at = mention.end;
    }
  }
  return text;
}

std::string spelled_for_command(const std::string& option) {
  if (option == "overwrite") return "--force";
  return (option.size() == 1 ? "-" : "--") + option;
}

std::string spelled_for_library(const std::string& option) {
  return std::string(kQuoted) + (option == "o" ? "out" : option) + "'";
}

}  // namespace mimetra
