// Run by mpirun on two processes: an input that one of them cannot read is refused by both, and
// neither waits for the other.

#include <cmath>
#include <functional>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMPIController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataAlgorithm.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringOutputWindow.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraGeodesic.h"
#include "plugins/paraview/mimetra/filters/vtkMimetraRegions.h"

using Pipeline = vtkStreamingDemandDrivenPipeline;
using testing::AnyOf;
using testing::HasSubstr;

namespace {

int process() {
  return vtkMultiProcessController::GetGlobalController()->GetLocalProcessId();
}

bool is_first() {
  return process() == 0;
}

/// Of each process a strip of a bump that goes along both, with global ids, at the times 0, 1, 2.
class Strips : public vtkPolyDataAlgorithm {
 public:
  vtkTypeMacro(Strips, vtkPolyDataAlgorithm);
  static Strips* New();

  /// What the second process does instead at a time.
  void fail_at(double time, std::function<int()> how) {
    fails_at_ = time;
    fail_ = std::move(how);
    Modified();
  }
  void repair() {
    fails_at_.reset();
    Modified();
  }

 protected:
  Strips() { SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**,
                         vtkInformationVector* outputs) override {
    vtkInformation* out = outputs->GetInformationObject(0);
    const double times[] = {0, 1, 2}, range[] = {0, 2};
    out->Set(Pipeline::TIME_STEPS(), times, 3);
    out->Set(Pipeline::TIME_RANGE(), range, 2);
    out->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override {
    const double time = outputs->GetInformationObject(0)->Get(Pipeline::UPDATE_TIME_STEP());
    if (fails_at_ == time && !is_first()) return fail_();
    constexpr int kRows = 5, kColumns = 6;
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> quads;
    vtkNew<vtkIdTypeArray> ids, cell_ids;
    ids->SetName("ids");
    cell_ids->SetName("ids");
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const int x = (kColumns - 1) * process() + column;
        const double height = std::exp(-(x - 4 - time) * (x - 4 - time) - (row - 2) * (row - 2));
        const vtkIdType v = points->InsertNextPoint(x, row, height);
        ids->InsertNextValue(row * (2 * kColumns - 1) + x);
        if (row + 1 == kRows || column + 1 == kColumns) continue;
        quads->InsertNextCell({v, v + 1, v + kColumns + 1, v + kColumns});
        cell_ids->InsertNextValue(ids->GetValue(v));
      }
    }
    vtkPolyData* mesh = vtkPolyData::GetData(outputs);
    mesh->SetPoints(points);
    mesh->SetPolys(quads);
    mesh->GetPointData()->SetGlobalIds(ids);
    mesh->GetCellData()->SetGlobalIds(cell_ids);
    mesh->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }

 private:
  std::optional<double> fails_at_ = {};
  std::function<int()> fail_ = {};
};

vtkStandardNewMacro(Strips);

/// By both processes: the points that a filter shows of this one's piece.
vtkIdType points_at(vtkMimetraFilter& filter, double time) {
  filter.UpdateTimeStep(time, process(), 2, 0);
  return filter.GetOutput()->GetNumberOfPoints();
}

constexpr vtkIdType kAll = 30;

class FailingInput : public testing::TestWithParam<std::function<int()>> {
 protected:
  FailingInput() {
    vtkOutputWindow::SetInstance(window_);
    geodesic_->SetInputConnection(strips_->GetOutputPort());
    regions_->SetInputConnection(strips_->GetOutputPort());
    regions_->SetInteger("k", 2);
  }
  ~FailingInput() override { vtkOutputWindow::SetInstance(nullptr); }

  /// Since it was asked before; of one failure, the first process has one thing to say.
  std::string said() {
    const std::string all = window_->GetOutput();
    return all.substr(std::exchange(known_, all.size()));
  }

  vtkNew<vtkStringOutputWindow> window_;
  std::size_t known_ = 0;
  vtkNew<Strips> strips_;
  vtkNew<vtkMimetraGeodesic> geodesic_;
  vtkNew<vtkMimetraRegions> regions_;
};

INSTANTIATE_TEST_SUITE_P(OfOneProcess, FailingInput,
                         testing::Values([] { return 0; },
                                         []() -> int { throw std::bad_alloc(); }));

}  // namespace

TEST_P(FailingInput, IsRefusedAtTheFirstTimeAndShownAtAnother) {
  strips_->fail_at(0, GetParam());
  EXPECT_EQ(points_at(*geodesic_, 0), 0);
  if (is_first()) {
    EXPECT_THAT(said(), HasSubstr("the input: cannot be read by another process"));
  }
  EXPECT_EQ(points_at(*geodesic_, 1), kAll);
  strips_->repair();
  EXPECT_EQ(points_at(*geodesic_, 0), kAll);
}

TEST_P(FailingInput, IsRefusedAtALaterTimeAndShownAtAnother) {
  strips_->fail_at(1, GetParam());
  EXPECT_EQ(points_at(*geodesic_, 0), kAll);
  EXPECT_EQ(points_at(*geodesic_, 1), 0);
  EXPECT_EQ(points_at(*geodesic_, 2), kAll);
  strips_->repair();
  EXPECT_EQ(points_at(*geodesic_, 1), kAll);
}

TEST_P(FailingInput, IsRefusedAgainAtTheSameTimeWithoutAWord) {
  strips_->fail_at(1, GetParam());
  EXPECT_EQ(points_at(*geodesic_, 1), 0);
  said();
  EXPECT_EQ(points_at(*geodesic_, 1), 0);
  geodesic_->SetText("source", "3");
  EXPECT_EQ(points_at(*geodesic_, 1), 0);
  if (is_first()) {
    EXPECT_EQ(said(), "");
  }
}

TEST_P(FailingInput, IsRefusedWhereAllTimesAreWanted) {
  for (const double time : {0, 1, 2}) {
    strips_->fail_at(time, GetParam());
    for (const double shown : {0, 2, 1, 1}) EXPECT_EQ(points_at(*regions_, shown), 0);
    if (is_first()) {
      EXPECT_THAT(said(), AnyOf(HasSubstr("cannot be read"), HasSubstr("process 1: not enough")));
    }
    strips_->repair();
    for (const double shown : {1, 0}) EXPECT_EQ(points_at(*regions_, shown), kAll);
  }
}

int main(int argc, char** argv) {
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  controller->Finalize();
  vtkMultiProcessController::SetGlobalController(nullptr);
  return failed;
}
