#include "plugins/c/value.h"

#include <nlohmann/json.hpp>

#include "toolkit/io/regions_file.h"
#include "toolkit/operations/json.h"

namespace mimetra {

const ShownArrays& Value::arrays() const {
  const std::lock_guard lock(mutex_);
  if (!arrays_) arrays_.emplace(named_.data);
  return *arrays_;
}

const std::string& Value::json() const {
  {
    const std::lock_guard lock(mutex_);
    if (json_) return *json_;
  }
  // Not while it is locked, because it asks for the arrays.
  std::string text = json_of(*this);
  const std::lock_guard lock(mutex_);
  if (!json_) json_ = std::move(text);
  return *json_;
}

std::string json_of(const Value& value) {
  const Data& data = value.named().data;
  if (const auto* regions = std::get_if<RegionData>(&data)) return regions_json(regions->regions);
  if (const auto* table = std::get_if<Table>(&data)) return table->json();
  if (const auto* fit = std::get_if<FittedCoefficients>(&data)) return fit_json(*fit);
  Json json = {
      {"name", value.named().name}, {"kind", kind_name(kind_of(data))}, {"arrays", Json::array()}};
  for (const mimetra_array& array : value.arrays().arrays()) {
    const std::vector<std::int64_t> shape(array.shape, array.shape + array.rank);
    json["arrays"].push_back({{"name", array.name}, {"shape", shape}});
  }
  return json_text(json);
}

}  // namespace mimetra
