#include "plugins/paraview/mimetra/filters/parcel.h"

#include <new>
#include <string>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommunicator.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

namespace {

constexpr int kTag = 23100;
constexpr int kFirst = 0;

void describe(vtkMultiProcessStream& words, vtkDataArray& array) {
  words << std::string(array.GetName() ? array.GetName() : "") << array.GetDataType()
        << array.GetNumberOfComponents() << vtkTypeInt64{array.GetNumberOfTuples()};
  for (int i = 0; i < array.GetNumberOfComponents(); ++i) {
    const char* name = array.GetComponentName(i);
    words << std::string(name ? name : "");
  }
}

vtkSmartPointer<vtkDataArray> as_described(vtkMultiProcessStream& words) {
  std::string name;
  int type = 0, components = 0;
  vtkTypeInt64 tuples = 0;
  words >> name >> type >> components >> tuples;
  vtkSmartPointer<vtkDataArray> array;
  array.TakeReference(vtkDataArray::CreateDataArray(type));
  if (!name.empty()) array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  for (int i = 0; i < components; ++i) {
    std::string component;
    words >> component;
    if (!component.empty()) array->SetComponentName(i, component.c_str());
  }
  if (!array->Resize(tuples)) throw std::bad_alloc();
  array->SetNumberOfTuples(tuples);
  return array;
}

vtkSmartPointer<vtkDataArray> as_ids(vtkDataArray* array) {
  const auto ids = vtkSmartPointer<vtkIdTypeArray>::New();
  ids->DeepCopy(array);
  return ids;
}

/// Returns whether an array has a name and numbers that can be sent.
bool travels(vtkAbstractArray* array) {
  return array->GetName() && vtkDataArray::SafeDownCast(array) && array->GetDataType() != VTK_BIT;
}

void put_fields(Parcel& parcel, vtkFieldData& fields) {
  int count = 0;
  for (int i = 0; i < fields.GetNumberOfArrays(); ++i) {
    count += travels(fields.GetAbstractArray(i)) ? 1 : 0;
  }
  parcel.words << count;
  for (int i = 0; i < fields.GetNumberOfArrays(); ++i) {
    if (travels(fields.GetAbstractArray(i))) parcel.put(fields.GetArray(i));
  }
}

void take_fields(Parcel& parcel, vtkFieldData& fields) {
  int count = 0;
  parcel.words >> count;
  for (int i = 0; i < count; ++i) fields.AddArray(parcel.take());
}

/// Adds the names of the arrays that are the normals, the global ids, ...
void put_roles(Parcel& parcel, vtkDataSetAttributes& attributes) {
  for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role) {
    vtkAbstractArray* active = attributes.GetAbstractAttribute(role);
    parcel.words << std::string(active && travels(active) ? active->GetName() : "");
  }
}

void take_roles(Parcel& parcel, vtkDataSetAttributes& attributes) {
  for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role) {
    std::string name;
    parcel.words >> name;
    if (!name.empty()) attributes.SetActiveAttribute(name.c_str(), role);
  }
}

vtkNew<vtkCellArray> taken_cells(Parcel& parcel) {
  vtkNew<vtkCellArray> cells;
  const auto offsets = parcel.take();
  const auto corners = parcel.take();
  cells->SetData(offsets, corners);
  return cells;
}

}  // namespace

void Parcel::put(vtkDataArray* array) {
  vtkSmartPointer<vtkDataArray> block = array;
  if (!array->HasStandardMemoryLayout()) {
    block.TakeReference(vtkDataArray::CreateDataArray(array->GetDataType()));
    block->DeepCopy(array);
  }
  arrays_.push_back(std::move(block));
}

vtkSmartPointer<vtkDataArray> Parcel::take() {
  return std::move(arrays_.at(next_++));
}

vtkMultiProcessStream Parcel::header() const {
  vtkMultiProcessStream header;
  header << static_cast<int>(arrays_.size());
  for (const auto& array : arrays_) describe(header, *array);
  put_words(header, words);
  return header;
}

Parcel Parcel::laid_out(vtkMultiProcessStream& header) {
  Parcel parcel;
  int count = 0;
  header >> count;
  for (int i = 0; i < count; ++i) parcel.arrays_.push_back(as_described(header));
  parcel.words = taken_words(header);
  return parcel;
}

void put_words(vtkMultiProcessStream& words, const vtkMultiProcessStream& inner) {
  const std::vector<unsigned char> bytes = inner.GetRawData();
  words << std::string(bytes.begin(), bytes.end());
}

vtkMultiProcessStream taken_words(vtkMultiProcessStream& words) {
  std::string bytes;
  words >> bytes;
  vtkMultiProcessStream inner;
  inner.SetRawData(std::vector<unsigned char>(bytes.begin(), bytes.end()));
  return inner;
}

void put_times(vtkMultiProcessStream& words, const std::vector<double>& times) {
  words << static_cast<int>(times.size());
  for (const double time : times) words << time;
}

std::vector<double> taken_times(vtkMultiProcessStream& words) {
  int count = 0;
  words >> count;
  std::vector<double> times(static_cast<std::size_t>(count));
  for (double& time : times) words >> time;
  return times;
}

Parcel packed(vtkPolyData& piece) {
  Parcel parcel;
  const bool has_points = piece.GetPoints() != nullptr;
  parcel.words << (has_points ? 1 : 0);
  if (has_points) parcel.put(piece.GetPoints()->GetData());
  for (vtkCellArray* cells :
       {piece.GetVerts(), piece.GetLines(), piece.GetPolys(), piece.GetStrips()}) {
    parcel.put(as_ids(cells->GetOffsetsArray()));
    parcel.put(as_ids(cells->GetConnectivityArray()));
  }
  put_fields(parcel, *piece.GetPointData());
  put_roles(parcel, *piece.GetPointData());
  put_fields(parcel, *piece.GetCellData());
  put_roles(parcel, *piece.GetCellData());
  put_fields(parcel, *piece.GetFieldData());
  return parcel;
}

vtkSmartPointer<vtkPolyData> unpacked(Parcel& parcel) {
  const auto piece = vtkSmartPointer<vtkPolyData>::New();
  int has_points = 0;
  parcel.words >> has_points;
  if (has_points == 1) {
    vtkNew<vtkPoints> points;
    points->SetData(parcel.take());
    piece->SetPoints(points);
  }
  piece->SetVerts(taken_cells(parcel));
  piece->SetLines(taken_cells(parcel));
  piece->SetPolys(taken_cells(parcel));
  piece->SetStrips(taken_cells(parcel));
  take_fields(parcel, *piece->GetPointData());
  take_roles(parcel, *piece->GetPointData());
  take_fields(parcel, *piece->GetCellData());
  take_roles(parcel, *piece->GetCellData());
  take_fields(parcel, *piece->GetFieldData());
  return piece;
}

int Processes::count() const {
  return controller_->GetNumberOfProcesses();
}

bool Processes::is_first() const {
  return controller_->GetLocalProcessId() == kFirst;
}

bool Processes::all(bool mine) {
  const int own = mine ? 1 : 0;
  int least = 0;
  controller_->AllReduce(&own, &least, 1, vtkCommunicator::MIN_OP);
  return least == 1;
}

vtkMultiProcessStream Processes::told(vtkMultiProcessStream words) {
  controller_->Broadcast(words, kFirst);
  return words;
}

void Processes::send(const Parcel& parcel, int to) {
  for (const auto& array : parcel.arrays_) {
    const vtkIdType count = array->GetNumberOfValues();
    if (count == 0) continue;
    controller_->GetCommunicator()->SendVoidArray(array->GetVoidPointer(0), count,
                                                  array->GetDataType(), to, kTag);
  }
}

void Processes::receive(Parcel& parcel, int from) {
  for (const auto& array : parcel.arrays_) {
    const vtkIdType count = array->GetNumberOfValues();
    if (count == 0) continue;
    controller_->GetCommunicator()->ReceiveVoidArray(array->GetVoidPointer(0), count,
                                                     array->GetDataType(), from, kTag);
  }
}

bool Processes::announce(const Parcel* parcel, int to) {
  vtkMultiProcessStream header;
  try {
    if (parcel) header = parcel->header();
  } catch (const std::bad_alloc&) {
    header.Reset();
  }
  controller_->Send(header, to, kTag);
  return !header.Empty();
}

std::optional<Parcel> Processes::announced(int from) {
  vtkMultiProcessStream header;
  controller_->Receive(header, from, kTag);
  if (header.Empty()) return {};
  try {
    return Parcel::laid_out(header);
  } catch (const std::bad_alloc&) {
    return {};
  }
}

std::optional<std::vector<Parcel>> Processes::gather(std::optional<Parcel> mine) {
  bool ready = mine.has_value();
  std::vector<Parcel> parcels;
  if (!is_first()) {
    ready = announce(mine ? &*mine : nullptr, kFirst);
  } else {
    parcels.push_back(mine.value_or(Parcel()));
    for (int from = 1; from < count(); ++from) {
      std::optional<Parcel> other = announced(from);
      ready = ready && other;
      parcels.push_back(std::move(other).value_or(Parcel()));
    }
  }
  if (!all(ready)) return {};
  if (!is_first()) send(*mine, kFirst);
  for (std::size_t from = 1; from < parcels.size(); ++from) {
    receive(parcels[from], static_cast<int>(from));
  }
  return parcels;
}

std::optional<Parcel> Processes::scatter(std::vector<Parcel> parcels) {
  std::optional<Parcel> mine;
  if (!is_first()) {
    mine = announced(kFirst);
  } else {
    for (std::size_t to = 1; to < parcels.size(); ++to) {
      announce(&parcels[to], static_cast<int>(to));
    }
    mine = std::move(parcels.front());
  }
  if (!all(mine.has_value())) return {};
  if (!is_first()) receive(*mine, kFirst);
  for (std::size_t to = 1; to < parcels.size(); ++to) send(parcels[to], static_cast<int>(to));
  return mine;
}
