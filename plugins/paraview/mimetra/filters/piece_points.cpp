#include "plugins/paraview/mimetra/filters/piece_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVariant.h>

#include "toolkit/mesh/errors.h"

using namespace mimetra;

namespace {

constexpr double kSeamWidth = 1e-6;
constexpr vtkIdType kNowhere = -1;

using Point = std::array<double, 3>;

Point position_of(vtkPolyData& piece, vtkIdType point) {
  Point position = {};
  piece.GetPoint(point, position.data());
  return position;
}

Point position_of(const Pieces& pieces, const PieceElement& point) {
  return position_of(*pieces[point.piece], point.index);
}

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::string name_of(const PieceElement& point) {
  return "point " + std::to_string(point.index) + " of process " + std::to_string(point.piece);
}

bool is_ghost_point(vtkPolyData& piece, vtkIdType point) {
  vtkUnsignedCharArray* ghosts = piece.GetPointGhostArray();
  return ghosts && (ghosts->GetValue(point) & vtkDataSetAttributes::DUPLICATEPOINT) != 0;
}

/// How a piece uses its points.
struct Uses {
  std::vector<bool> own;     ///< points of the piece itself, not of a ghost only
  std::vector<bool> border;  ///< on an edge of one polygon, where another piece may continue
  std::vector<bool> loose;   ///< in no own cell of the piece
};

/// Edges as pairs of corners, the lower one first.
using Edges = std::vector<std::pair<vtkIdType, vtkIdType>>;

void add_edges(Edges& edges, vtkIdList& corners) {
  const vtkIdType count = corners.GetNumberOfIds();
  for (vtkIdType i = 0; i < count; ++i) {
    edges.push_back(std::minmax({corners.GetId(i), corners.GetId((i + 1) % count)}));
  }
}

Uses uses_of(vtkPolyData& piece) {
  const auto points = static_cast<std::size_t>(piece.GetNumberOfPoints());
  std::vector<bool> of_own_cell(points), of_ghost_cell(points), border(points);
  Edges edges;
  vtkNew<vtkIdList> corners;
  vtkIdType cell = 0;
  for (vtkCellArray* cells :
       {piece.GetVerts(), piece.GetLines(), piece.GetPolys(), piece.GetStrips()}) {
    for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i, ++cell) {
      cells->GetCellAtId(i, corners);
      auto& used = is_ghost_cell(piece, cell) ? of_ghost_cell : of_own_cell;
      for (const vtkIdType corner : *corners) used[static_cast<std::size_t>(corner)] = true;
      const bool is_polygon = cells == piece.GetPolys();
      if (is_polygon && !is_ghost_cell(piece, cell)) add_edges(edges, *corners);
    }
  }
  std::ranges::sort(edges);
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
    if (next - edge == 1) {
      border[static_cast<std::size_t>(edge->first)] = true;
      border[static_cast<std::size_t>(edge->second)] = true;
    }
    edge = next;
  }
  std::vector<bool> own(points), loose(points);
  for (std::size_t i = 0; i < points; ++i) {
    const bool is_ghost = of_ghost_cell[i] || is_ghost_point(piece, static_cast<vtkIdType>(i));
    own[i] = of_own_cell[i] || !is_ghost;
    loose[i] = !of_own_cell[i];
  }
  return {std::move(own), std::move(border), std::move(loose)};
}

/// Finds points of pieces by their positions.
class PointFinder {
 public:
  PointFinder(const Pieces& pieces, std::vector<PieceElement> points)
      : width_(seam_width(pieces)), points_(std::move(points)) {
    vtkNew<vtkPoints> positions;
    positions->SetDataTypeToDouble();
    for (const PieceElement& point : points_) {
      positions->InsertNextPoint(position_of(pieces, point).data());
    }
    cloud_->SetPoints(positions);
    locator_->SetDataSet(cloud_);
    locator_->BuildLocator();
  }

  const std::vector<PieceElement>& points() const { return points_; }

  /// Indices of the points within seam_width(), ascending.
  std::vector<std::size_t> near(const Point& position) const {
    if (points_.empty()) return {};
    vtkNew<vtkIdList> found;
    locator_->FindPointsWithinRadius(width_, position.data(), found);
    std::vector<std::size_t> indices(found->begin(), found->end());
    std::ranges::sort(indices);
    return indices;
  }

 private:
  double width_;
  std::vector<PieceElement> points_;
  vtkNew<vtkPolyData> cloud_;
  vtkNew<vtkStaticPointLocator> locator_;
};

std::vector<PieceElement> points_where(const Pieces& pieces, const auto& wanted) {
  std::vector<PieceElement> points;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    for (vtkIdType i = 0; i < pieces[piece]->GetNumberOfPoints(); ++i) {
      if (wanted(piece, static_cast<std::size_t>(i))) points.push_back({piece, i});
    }
  }
  return points;
}

std::vector<Places> no_places(const Pieces& pieces) {
  std::vector<Places> places;
  for (const auto& piece : pieces) {
    places.emplace_back(static_cast<std::size_t>(piece->GetNumberOfPoints()), kNowhere);
  }
  return places;
}

vtkIdType& place_of(std::vector<Places>& places, const PieceElement& point) {
  return places[point.piece][static_cast<std::size_t>(point.index)];
}

/// Gives `point` its place. A point of the mesh takes its data from a piece that owns it, if any
/// does.
void add_holder(const Pieces& pieces, PiecePoints& joined, const PieceElement& point,
                vtkIdType place) {
  place_of(joined.places, point) = place;
  if (place == static_cast<vtkIdType>(joined.holders.size())) {
    joined.holders.push_back(point);
    return;
  }
  PieceElement& holder = joined.holders[static_cast<std::size_t>(place)];
  const bool is_owned = !is_ghost_point(*pieces[point.piece], point.index);
  if (is_owned && is_ghost_point(*pieces[holder.piece], holder.index)) holder = point;
}

[[noreturn]] void refuse_ghost(const PieceElement& point, const char* why) {
  throw MismatchError(name_of(point) + " is a ghost " + why +
                      "; remove the ghosts by the filter Remove Ghost Information, or distribute "
                      "the mesh anew");
}

/// Global ids of each piece's points.
using PieceIds = std::vector<std::vector<vtkTypeInt64>>;

PieceIds ids_of(const Pieces& pieces) {
  PieceIds ids;
  for (const auto& piece : pieces) {
    vtkDataArray* array = piece->GetPointData()->GetGlobalIds();
    ids.push_back(array ? ids_of(*array) : std::vector<vtkTypeInt64>());
  }
  return ids;
}

vtkTypeInt64 id_of(const PieceIds& ids, const PieceElement& point) {
  return ids[point.piece][static_cast<std::size_t>(point.index)];
}

/// Throws MismatchError if two points cannot have the same id.
void expect_same(const Pieces& pieces, vtkTypeInt64 number, const PieceElement& a,
                 const PieceElement& b, double width) {
  const std::string id = "global id " + std::to_string(number);
  if (a.piece == b.piece) {
    throw MismatchError(id + " names point " + std::to_string(a.index) + " and " +
                        std::to_string(b.index) + " of process " + std::to_string(a.piece) +
                        "; expected one for each point");
  }
  if (distance(position_of(pieces, a), position_of(pieces, b)) > width) {
    throw MismatchError(id + " names " + name_of(a) + " and " + name_of(b) +
                        ", which are at different positions");
  }
}

/// Throws MismatchError if ids keep a seam open. Pieces computed apart may put one point at nearly,
/// but not exactly, the same position, and Generate Global Ids then gives it two ids. Points at
/// exactly the same position have different ids on purpose.
void expect_no_open_seams(const Pieces& pieces, const std::vector<Uses>& uses,
                          const PieceIds& ids) {
  const PointFinder borders(pieces, points_where(pieces, [&](std::size_t piece, std::size_t i) {
                              return uses[piece].own[i] && uses[piece].border[i];
                            }));
  for (const PieceElement& point : borders.points()) {
    const Point position = position_of(pieces, point);
    for (const std::size_t index : borders.near(position)) {
      const PieceElement& other = borders.points()[index];
      if (other.piece <= point.piece || id_of(ids, other) == id_of(ids, point)) continue;
      if (distance(position, position_of(pieces, other)) == 0) continue;
      throw MismatchError(name_of(point) + " and " + name_of(other) +
                          " are nearly at one position, but have different global ids; give "
                          "Generate Global Ids a Tolerance, or use it before the mesh is "
                          "distributed");
    }
  }
}

PiecePoints joined_by_ids(const Pieces& pieces, const std::vector<Uses>& uses) {
  PiecePoints joined{no_places(pieces), {}, true};
  const PieceIds ids = ids_of(pieces);
  std::vector<PieceElement> own = points_where(
      pieces, [&](std::size_t piece, std::size_t i) { return bool{uses[piece].own[i]}; });
  std::ranges::stable_sort(own, {}, [&](const PieceElement& p) { return id_of(ids, p); });
  const double width = seam_width(pieces);
  std::vector<vtkTypeInt64> known;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const vtkTypeInt64 id = id_of(ids, own[i]);
    if (known.empty() || known.back() != id) {
      known.push_back(id);
    } else {
      expect_same(pieces, id, own[i - 1], own[i], width);
    }
    add_holder(pieces, joined, own[i], static_cast<vtkIdType>(known.size()) - 1);
  }
  const auto count = static_cast<vtkTypeInt64>(known.size());
  joined.counted = count == 0 || (known.front() == 0 && known.back() == count - 1);
  expect_no_open_seams(pieces, uses, ids);
  for (const PieceElement& ghost : points_where(
           pieces, [&](std::size_t piece, std::size_t i) { return !uses[piece].own[i]; })) {
    const auto found = std::ranges::lower_bound(known, id_of(ids, ghost));
    if (found == known.end() || *found != id_of(ids, ghost)) refuse_ghost(ghost, "of no process");
    place_of(joined.places, ghost) = found - known.begin();
  }
  return joined;
}

/// Sets of points that are one, each identified by its lowest member.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::size_t root(std::size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void unite(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent_[high] = low;
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Throws MismatchError if a group has two points of one piece.
void expect_one_of_each(const Groups& groups, const std::vector<PieceElement>& points) {
  std::vector<std::pair<std::size_t, std::size_t>> members;  // group, index of a point
  for (std::size_t i = 0; i < points.size(); ++i) members.push_back({groups.root(i), i});
  std::ranges::sort(members);
  for (std::size_t i = 1; i < members.size(); ++i) {
    const PieceElement& a = points[members[i - 1].second];
    const PieceElement& b = points[members[i].second];
    if (members[i].first != members[i - 1].first || a.piece != b.piece) continue;
    throw MismatchError(name_of(a) + " and point " + std::to_string(b.index) +
                        " are at one position, where another process has a point too: which of "
                        "them it is cannot be known; " +
                        kNumberThem);
  }
}

bool is_border(const std::vector<Uses>& uses, const PieceElement& point) {
  return uses[point.piece].border[static_cast<std::size_t>(point.index)];
}

bool is_loose(const std::vector<Uses>& uses, const PieceElement& point) {
  return uses[point.piece].loose[static_cast<std::size_t>(point.index)];
}

/// Groups of points to join. `finder` holds all own points. Throws MismatchError if a point inside
/// a piece is at a point of another. It may be a copy, or belong to another surface.
Groups seams(const Pieces& pieces, const std::vector<Uses>& uses, const PointFinder& finder) {
  const std::vector<PieceElement>& points = finder.points();
  Groups groups(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const std::size_t other : finder.near(position_of(pieces, points[i]))) {
      if (points[other].piece <= points[i].piece) continue;
      const bool one_is_loose = is_loose(uses, points[i]) || is_loose(uses, points[other]);
      if (!one_is_loose && !(is_border(uses, points[i]) && is_border(uses, points[other]))) {
        throw MismatchError(name_of(points[i]) + " and " + name_of(points[other]) +
                            " are at one position, but not at the border of both pieces: whether "
                            "they are one point, marked as no ghost, or two cannot be known; " +
                            kNumberThem);
      }
      groups.unite(i, other);
    }
  }
  expect_one_of_each(groups, points);
  return groups;
}

PiecePoints joined_by_positions(const Pieces& pieces, const std::vector<Uses>& uses) {
  PiecePoints joined{no_places(pieces), {}};
  const PointFinder finder(pieces, points_where(pieces, [&](std::size_t piece, std::size_t i) {
                             return bool{uses[piece].own[i]};
                           }));
  const std::vector<PieceElement>& own = finder.points();
  const Groups groups = seams(pieces, uses, finder);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::size_t root = groups.root(i);
    const auto next = static_cast<vtkIdType>(joined.holders.size());
    add_holder(pieces, joined, own[i], root == i ? next : place_of(joined.places, own[root]));
  }
  joined.joined = own.size() - joined.holders.size();
  for (const PieceElement& ghost : points_where(
           pieces, [&](std::size_t piece, std::size_t i) { return !uses[piece].own[i]; })) {
    std::optional<vtkIdType> place;
    for (const std::size_t index : finder.near(position_of(pieces, ghost))) {
      const vtkIdType found = place_of(joined.places, own[index]);
      if (place && *place != found) refuse_ghost(ghost, "of one of several points");
      place = found;
    }
    if (!place) refuse_ghost(ghost, "of no process");
    place_of(joined.places, ghost) = *place;
  }
  return joined;
}

}  // namespace

std::vector<vtkTypeInt64> ids_of(vtkDataArray& ids) {
  std::vector<vtkTypeInt64> numbers;
  for (vtkIdType i = 0; i < ids.GetNumberOfTuples(); ++i) {
    numbers.push_back(ids.GetVariantValue(i).ToTypeInt64());
  }
  return numbers;
}

bool is_part(vtkPolyData& piece) {
  if (piece.GetPointData()->GetGlobalIds()) return true;
  for (vtkIdType i = 0; i < piece.GetNumberOfPoints(); ++i) {
    if (is_ghost_point(piece, i)) return true;
  }
  for (vtkIdType i = 0; i < piece.GetNumberOfCells(); ++i) {
    if (is_ghost_cell(piece, i)) return true;
  }
  return false;
}

void expect_finite(const Pieces& pieces) {
  const auto all_points = points_where(pieces, [](std::size_t, std::size_t) { return true; });
  for (const PieceElement& point : all_points) {
    const Point position = position_of(pieces, point);
    if (std::ranges::all_of(position, [](double x) { return std::isfinite(x); })) continue;
    throw MismatchError(name_of(point) + " is not finite");
  }
}

bool is_ghost_cell(vtkPolyData& piece, vtkIdType cell) {
  vtkUnsignedCharArray* ghosts = piece.GetCellGhostArray();
  return ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0;
}

double seam_width(const Pieces& pieces) {
  double largest = 0;
  for (const auto& piece : pieces) {
    if (piece->GetNumberOfPoints() == 0) continue;
    for (const double bound : std::span(piece->GetBounds(), 6)) {
      largest = std::max(largest, std::abs(bound));
    }
  }
  return kSeamWidth * largest;
}

PiecePoints joined_points(const Pieces& pieces) {
  std::vector<Uses> uses;
  bool named = true;
  for (const auto& piece : pieces) {
    uses.push_back(uses_of(*piece));
    named = named && (piece->GetNumberOfPoints() == 0 || piece->GetPointData()->GetGlobalIds());
  }
  return named ? joined_by_ids(pieces, uses) : joined_by_positions(pieces, uses);
}

void expect_joined(const Pieces& pieces, const std::vector<Places>& places) {
  const double width = seam_width(pieces);
  std::vector<std::optional<PieceElement>> first;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    for (std::size_t i = 0; i < places[piece].size(); ++i) {
      const auto place = static_cast<std::size_t>(places[piece][i]);
      const PieceElement point{piece, static_cast<vtkIdType>(i)};
      first.resize(std::max(first.size(), place + 1));
      if (!first[place]) first[place] = point;
      if (distance(position_of(pieces, *first[place]), position_of(pieces, point)) <= width) {
        continue;
      }
      throw MismatchError(name_of(*first[place]) + " and " + name_of(point) +
                          " were at one position before and have parted; " + kNumberThem);
    }
  }
}
