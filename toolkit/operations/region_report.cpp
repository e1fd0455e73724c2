#include "toolkit/operations/region_report.h"

#include <nlohmann/json.hpp>

#include "toolkit/mesh/text.h"
#include "toolkit/operations/counted.h"

namespace mimetra {

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

}  // namespace mimetra
