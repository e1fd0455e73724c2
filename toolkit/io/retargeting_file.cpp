#include "toolkit/io/retargeting_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "toolkit/io/csv.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

constexpr const char* kMapForm = "a map of weights, as 'mimetra retarget --map-out' writes it";
constexpr const char* kMapKind = "weights of one rig to another";
constexpr int kMapVersion = 1;
const std::vector<std::string> kMapMembers = {"kind",  "version", "source", "target",
                                              "lower", "upper",   "gram",   "linear"};

Json json_of_vector(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return Json(std::vector<double>(values.begin(), values.end()));
}

Json json_of_rows(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    rows.push_back(json_of_vector(matrix.row(row).transpose()));
  }
  return rows;
}

class MapReader {
 public:
  MapReader(const std::string& path, std::string_view text)
      : path_(path), root_(parse_json(path, text, kMapForm)) {
    check_members();
  }

  Retargeting read() const {
    Retargeting map;
    map.source_names = names("source");
    map.target_names = names("target");
    const std::size_t sources = map.source_names.size(), targets = map.target_names.size();
    map.lower = numbers(root_.at("lower"), "lower", targets);
    map.upper = numbers(root_.at("upper"), "upper", targets);
    map.gram = matrix("gram", targets, targets);
    map.linear = matrix("linear", targets, sources);
    try {
      map.check();
    } catch (const std::invalid_argument& error) {
      throw IoError(path_, std::string(error.what()) + "; make the file again with --map-out");
    }
    return map;
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& expected,
                         const std::string& found) const {
    throw IoError(path_, place + ": expected " + expected + ", found " + found);
  }

  void check_members() const {
    if (!root_.is_object()) throw IoError(path_, std::string("expected ") + kMapForm);
    for (const std::string& member : kMapMembers) {
      if (root_.contains(member)) continue;
      throw IoError(path_, "has no '" + member + "'; expected " + kMapForm);
    }
    for (const auto& [key, value] : root_.items()) {
      if (std::ranges::find(kMapMembers, key) != kMapMembers.end()) continue;
      throw IoError(path_, "'" + key + "' is unknown; a map has " +
                               joined(kMapMembers, ", ", " and ") + "; leave it out");
    }
    if (root_.at("kind") != kMapKind) {
      fail("kind", std::string("'") + kMapKind + "'", short_text(root_.at("kind")));
    }
    if (root_.at("version") != kMapVersion) {
      fail("version", std::to_string(kMapVersion),
           short_text(root_.at("version")) + "; make the file again with this program");
    }
  }

  std::vector<std::string> names(const std::string& member) const {
    const Json& list = root_.at(member);
    if (!list.is_array()) fail(member, "a list of names", short_text(list));
    std::vector<std::string> found;
    for (const Json& name : list) {
      if (!name.is_string()) {
        fail(member + "/" + std::to_string(found.size()), "a name", short_text(name));
      }
      found.push_back(name.get<std::string>());
    }
    return found;
  }

  Eigen::VectorXd numbers(const Json& list, const std::string& place, std::size_t count) const {
    const std::string expected = std::to_string(count) + " numbers";
    if (!list.is_array()) fail(place, expected, short_text(list));
    if (list.size() != count) fail(place, expected, std::to_string(list.size()));
    Eigen::VectorXd values(static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      if (!list[i].is_number() || !std::isfinite(list[i].get<double>())) {
        fail(place + "/" + std::to_string(i), "a finite number", short_text(list[i]));
      }
      values[static_cast<Eigen::Index>(i)] = list[i].get<double>();
    }
    return values;
  }

  Eigen::MatrixXd matrix(const std::string& member, std::size_t rows, std::size_t columns) const {
    const Json& list = root_.at(member);
    const std::string expected =
        std::to_string(rows) + " rows, one for each expression of 'target'";
    if (!list.is_array()) fail(member, expected, short_text(list));
    if (list.size() != rows) fail(member, expected, std::to_string(list.size()));
    Eigen::MatrixXd values(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    for (std::size_t row = 0; row < rows; ++row) {
      values.row(static_cast<Eigen::Index>(row)) =
          numbers(list[row], member + "/" + std::to_string(row), columns).transpose();
    }
    return values;
  }

  std::string path_;
  Json root_;
};

}  // namespace

std::string retargeting_json(const Retargeting& map) {
  return json_text(Json{{"kind", kMapKind},
                        {"version", kMapVersion},
                        {"source", map.source_names},
                        {"target", map.target_names},
                        {"lower", json_of_vector(map.lower)},
                        {"upper", json_of_vector(map.upper)},
                        {"gram", json_of_rows(map.gram)},
                        {"linear", json_of_rows(map.linear)}}) +
         '\n';
}

Retargeting parse_retargeting(const std::string& path, std::string_view text) {
  return MapReader(path, text).read();
}

std::string plain_matrix_csv(const Retargeting& map, const Eigen::MatrixXd& matrix) {
  std::string text = "expression";
  for (const std::string& name : map.source_names) text += ',' + csv_field(name);
  text += '\n';
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += csv_field(map.target_names.at(static_cast<std::size_t>(row)));
    for (const double number : matrix.row(row)) {
      text += ',';
      append_number(text, number);
    }
    text += '\n';
  }
  return text;
}

}  // namespace mimetra
