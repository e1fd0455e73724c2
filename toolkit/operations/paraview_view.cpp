#include "toolkit/operations/paraview_view.h"

#include <algorithm>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/operations/colors.h"
#include "toolkit/operations/json.h"

namespace mimetra {

namespace {

/// The colour of each region, by its number; -1 is what none covers.
std::map<int, Color> colors_of(const RegionData& regions) {
  const std::vector<Field>& fields = regions.fields.fields;
  const Field& region = *std::ranges::find(fields, "region", &Field::name);
  std::vector<int> labels;
  for (const double value : region.values.reshaped()) labels.push_back(static_cast<int>(value));
  const std::vector<Color> colors = category_colors(labels, regions.fields.frames->triangles());
  std::map<int, Color> by_region = {{-1, kClay}};
  for (std::size_t v = 0; v < labels.size(); ++v) by_region.emplace(labels[v], colors[v]);
  return by_region;
}

/// A string of Python: JSON's escapes are Python's, save those of characters beyond 16 bits.
std::string quoted(const std::string& text) {
  return json_text(text);
}

std::string list_of(const Eigen::RowVector3d& point) {
  std::ostringstream text;
  text.precision(9);
  text << '[' << point.x() << ", " << point.y() << ", " << point.z() << ']';
  return text.str();
}

/// `name = value` lines that say which colour and name each value has.
std::string categories(const std::map<int, Color>& colors) {
  std::ostringstream names, values;
  values.precision(3);
  for (const auto& [region, color] : colors) {
    const char* separator = region == colors.begin()->first ? "" : ", ";
    names << separator << '"' << region << "\", \""
          << (region < 0 ? "none" : std::to_string(region)) << '"';
    values << separator << color.red / 255.0 << ", " << color.green / 255.0 << ", "
           << color.blue / 255.0;
  }
  return "colors.Annotations = [" + names.str() + "]\ncolors.IndexedColors = [" + values.str() +
         "]\n";
}

/// Orthographic, a little from the side and from above.
std::string camera(const Positions& rest, UpAxis up) {
  const auto axes = [up](double right, double above, double front) {
    return up == UpAxis::y ? Eigen::RowVector3d(right, above, front)
                           : Eigen::RowVector3d(right, 0 - front, above);
  };
  const Eigen::RowVector3d low = rest.colwise().minCoeff(), high = rest.colwise().maxCoeff();
  const Eigen::RowVector3d middle = (low + high) / 2;
  const double size = (high - low).norm();
  const Eigen::RowVector3d from = middle + 2 * size * axes(0.26, 0.09, 0.96);
  const Eigen::RowVector3d seen = axes(1, 1, 0).cwiseProduct(high - low);
  std::ostringstream text;
  text << "view.CameraParallelProjection = 1\nview.CameraFocalPoint = " << list_of(middle)
       << "\nview.CameraPosition = " << list_of(from)
       << "\nview.CameraViewUp = " << list_of(axes(0, 1, 0)) << '\n'
       << "view.CameraParallelScale = " << 0.6 * seen.maxCoeff() << '\n';
  return text.str();
}

constexpr const char* kHead = R"(# Regions of a sequence in ParaView:    paraview --script=VIEW.py
# or in a picture, without a window:    pvpython VIEW.py PICTURE.png
import sys

from paraview.simple import *

)";

constexpr const char* kColoring = R"(
view = GetActiveViewOrCreate("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesVisibility = 0
# Without a dark side.
view.FillLightKFRatio = 1.5
view.HeadLightKHRatio = 1.5
# Each face in the colour of the region that most of its points are in: colours do not blend.
faces = PointDatatoCellData(reader, CategoricalData=1, PassPointData=1)
# Without normals the light shows every face. Newer versions name the filter SurfaceNormals.
add_normals = globals().get("SurfaceNormals") or GenerateSurfaceNormals
faces = add_normals(faces, Splitting=0, Consistency=0)
display = Show(faces, view)
ColorBy(display, ("CELLS", "region"))
colors = GetColorTransferFunction("region")
colors.InterpretValuesAsCategories = 1
colors.AnnotationsInitialized = 1
)";

constexpr const char* kLegend = R"(
display.SetScalarBarVisibility(view, True)
legend = GetScalarBar(colors, view)
legend.Title = "region"
legend.ComponentTitle = ""
legend.TitleColor = legend.LabelColor = [0, 0, 0]
legend.WindowLocation = "Any Location"
legend.Position = [0.9, 0.03]
legend.ScalarBarLength = 0.9
legend.TitleFontSize = legend.LabelFontSize = 10

time = AnnotateTimeFilter(reader)
time.Format = "{time:.2f} s"
clock = Show(time, view)
clock.Color = [0, 0, 0]
clock.FontSize = 12
clock.WindowLocation = "Lower Left Corner"
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
SetActiveSource(faces)

Render(view)
)";

constexpr const char* kEnd = R"(Render(view)

if len(sys.argv) == 2 and sys.argv[1].endswith(".png"):
    view.ViewSize = [1280, 800]
    SaveScreenshot(sys.argv[1], view, ImageResolution=view.ViewSize)
)";

}  // namespace

std::string paraview_view(const RegionData& regions, const std::filesystem::path& series,
                          UpAxis up) {
  const std::string name = series.stem().string();
  return kHead + ("reader = OpenDataFile(" + quoted(series.string()) + ")\n") + "RenameSource(" +
         quoted(name) + ", reader)\n" + kColoring + categories(colors_of(regions)) + kLegend +
         camera(regions.fields.frames->rest(), up) + kEnd;
}

}  // namespace mimetra
