#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "plugins/paraview/mimetra/filters/merged_pieces.h"

/// A square, cut into pieces as processes of a server have them.
namespace mimetra::test {

using Mesh = vtkSmartPointer<vtkPolyData>;

inline constexpr int kSize = 5;

template <typename Array>
vtkSmartPointer<Array> numbers(const char* name, vtkIdType count,
                               const std::function<double(vtkIdType)>& value) {
  const auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i) array->SetTuple1(i, value(i));
  return array;
}

/// A bent square of quads, with point data `at` and cell data `on`, their own numbers.
inline Mesh square() {
  const auto mesh = Mesh::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      points->InsertNextPoint(column, row, std::sin(row * 0.7 + column));
    }
  }
  mesh->SetPoints(points);
  vtkNew<vtkCellArray> quads;
  for (int row = 0; row + 1 < kSize; ++row) {
    for (int column = 0; column + 1 < kSize; ++column) {
      const vtkIdType v = row * kSize + column;
      quads->InsertNextCell({v, v + 1, v + kSize + 1, v + kSize});
    }
  }
  mesh->SetPolys(quads);
  const auto itself = [](vtkIdType i) { return static_cast<double>(i); };
  mesh->GetPointData()->AddArray(
      numbers<vtkDoubleArray>("at", points->GetNumberOfPoints(), itself));
  mesh->GetCellData()->AddArray(numbers<vtkDoubleArray>("on", quads->GetNumberOfCells(), itself));
  return mesh;
}

enum class Ids { none, points, points_and_cells };

/// Cells of a mesh, in an order, with the points that they use in the order of their use.
inline Mesh piece_of(vtkPolyData& mesh, const std::vector<vtkIdType>& cells, Ids ids = Ids::none) {
  const auto piece = Mesh::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> quads;
  std::vector<vtkIdType> from;
  vtkNew<vtkIdList> corners;
  for (const vtkIdType cell : cells) {
    mesh.GetPolys()->GetCellAtId(cell, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i) {
      const vtkIdType point = corners->GetId(i);
      const auto known = std::ranges::find(from, point);
      corners->SetId(i, known - from.begin());
      if (known != from.end()) continue;
      from.push_back(point);
      points->InsertNextPoint(mesh.GetPoint(point));
    }
    quads->InsertNextCell(corners);
  }
  piece->SetPoints(points);
  piece->SetPolys(quads);
  const auto count = static_cast<vtkIdType>(from.size());
  const auto of_point = [&](vtkIdType i) { return static_cast<double>(from[std::size_t(i)]); };
  const auto of_cell = [&](vtkIdType i) { return static_cast<double>(cells[std::size_t(i)]); };
  const auto all = static_cast<vtkIdType>(cells.size());
  piece->GetPointData()->AddArray(numbers<vtkDoubleArray>("at", count, of_point));
  piece->GetCellData()->AddArray(numbers<vtkDoubleArray>("on", all, of_cell));
  if (ids != Ids::none) {
    piece->GetPointData()->SetGlobalIds(numbers<vtkIdTypeArray>("ids", count, of_point));
  }
  if (ids == Ids::points_and_cells) {
    piece->GetCellData()->SetGlobalIds(numbers<vtkIdTypeArray>("ids", all, of_cell));
  }
  return piece;
}

/// Each cell in a piece of its own choice; the last piece is empty.
inline Pieces scattered(vtkPolyData& mesh, unsigned seed, Ids ids) {
  std::mt19937 random(seed);
  std::array<std::vector<vtkIdType>, 3> cells;
  std::vector<vtkIdType> order(static_cast<std::size_t>(mesh.GetNumberOfCells()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  for (const vtkIdType cell : order) cells[random() % cells.size()].push_back(cell);
  Pieces pieces;
  for (const auto& each : cells) pieces.push_back(piece_of(mesh, each, ids));
  pieces.push_back(Mesh::New());
  return pieces;
}

/// The halves of the square.
inline Pieces halves(Ids ids = Ids::none) {
  const Mesh mesh = square();
  return {piece_of(*mesh, {0, 1, 2, 3, 4, 5, 6, 7}, ids),
          piece_of(*mesh, {8, 9, 10, 11, 12, 13, 14, 15}, ids)};
}

inline double value(vtkDataSetAttributes& attributes, const char* name, vtkIdType i) {
  return attributes.GetArray(name)->GetTuple1(i);
}

inline std::vector<vtkIdType> corners_of(vtkPolyData& mesh, vtkIdType cell) {
  vtkNew<vtkIdList> corners;
  mesh.GetPolys()->GetCellAtId(cell, corners);
  return {corners->begin(), corners->end()};
}

}  // namespace mimetra::test
