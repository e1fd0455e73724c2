#include "toolkit/io/data.h"

#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/io/csv.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {

std::string_view kind_name(DataKind kind) {
  switch (kind) {
    case DataKind::sequence:
      return "sequence";
    case DataKind::model:
      return "model";
    case DataKind::components:
      return "components";
    case DataKind::regions:
      return "regions";
    case DataKind::table:
      return "table";
    case DataKind::landmarks:
      return "landmarks";
    case DataKind::fit:
      return "fitted coefficients";
    case DataKind::pictures:
      return "pictures";
    case DataKind::document:
      return "document";
  }
  return "";
}

DataKind kind_of(const Data& data) {
  return static_cast<DataKind>(data.index());
}

Data in_memory(Data data, const Context& context) {
  const auto* streamed = std::get_if<FieldSequence>(&data);
  if (!streamed || streamed->is_in_memory()) return data;
  return FieldSequence(MeshSequence(*streamed->frames, context), streamed->fields,
                       streamed->displacement);
}

const BlendshapeModel& person_of(const NamedData& value) {
  return std::get<ModelData>(value.data).model.average();
}

Pictures Pictures::of(Image image) {
  return {1, [held = std::make_shared<const Image>(std::move(image))](int) { return *held; }};
}

std::string Table::csv() const {
  std::ostringstream text;
  for (std::size_t column = 0; column < columns.size(); ++column) {
    text << (column > 0 ? "," : "") << csv_field(columns[column]);
  }
  if (!word_column.empty()) text << ',' << csv_field(word_column);
  text << '\n';
  for (const auto& row : rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (column > 0) text << ',';
      if (row[column]) text << to_text(*row[column]);
    }
    if (!word_column.empty()) text << ',' << csv_field(words.at(&row - rows.data()));
    text << '\n';
  }
  return text.str();
}

std::string Table::json() const {
  Json list = Json::array();
  for (const auto& row : rows) {
    Json entry;
    for (std::size_t column = 0; column < columns.size(); ++column) {
      entry[columns[column]] = row[column] ? Json(*row[column]) : Json(nullptr);
    }
    if (!word_column.empty()) {
      const std::string& word = words.at(&row - rows.data());
      entry[word_column] = word.empty() ? Json(nullptr) : Json(word);
    }
    list.push_back(entry);
  }
  return json_text(Json{{"rows", list}}, 2) + '\n';
}

}  // namespace mimetra
