#include "plugins/paraview/mimetra/filters/processes.h"

#include <new>

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>

namespace {

constexpr int kFirst = 0;
constexpr int kTag = 23100;

}  // namespace

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

bool Processes::is_first() const {
  return controller_->GetLocalProcessId() == kFirst;
}

Processes::Data Processes::nothing() const {
  return Data(static_cast<std::size_t>(controller_->GetNumberOfProcesses()));
}

bool Processes::all(bool mine) {
  const int own = mine ? 1 : 0;
  int least = 0;
  controller_->AllReduce(&own, &least, 1, vtkCommunicator::MIN_OP);
  return least == 1;
}

void Processes::together(const std::function<void()>& work) {
  bool is_done = true;
  try {
    work();
  } catch (const std::bad_alloc&) {
    is_done = false;
  }
  if (!all(is_done)) throw std::bad_alloc();
}

vtkMultiProcessStream Processes::told(vtkMultiProcessStream words) {
  controller_->Broadcast(words, kFirst);
  return words;
}

std::vector<vtkMultiProcessStream> Processes::gathered(const vtkMultiProcessStream& words) {
  std::vector<vtkMultiProcessStream> all;
  controller_->Gather(words, all, kFirst);
  return all;
}

// VTK's own Gather() sends at most 2 GB, and waits forever if memory is short.
Processes::Data Processes::exchanged(const Data& mine) {
  const auto own = static_cast<std::size_t>(controller_->GetLocalProcessId());
  const std::size_t count = mine.size();
  std::vector<vtkNew<vtkCharArray>> sent(count), received(count);
  together([&] {
    for (std::size_t to = 0; to < count; ++to) {
      if (to == own || vtkCommunicator::MarshalDataObject(mine[to], sent[to])) continue;
      throw std::bad_alloc();
    }
  });
  std::vector<vtkIdType> sizes, all_sizes(count * count);
  for (const auto& bytes : sent) sizes.push_back(bytes->GetNumberOfValues());
  controller_->AllGather(sizes.data(), all_sizes.data(), static_cast<vtkIdType>(count));
  together([&] {
    for (std::size_t from = 0; from < count; ++from) {
      received[from]->SetNumberOfValues(all_sizes[from * count + own]);
    }
  });
  for (std::size_t from = 0; from < count; ++from) {
    for (std::size_t to = 0; to < count; ++to) {
      const vtkIdType size = all_sizes[from * count + to];
      if (size == 0) continue;
      if (from == own) {
        controller_->Send(sent[to]->GetPointer(0), size, static_cast<int>(to), kTag);
      } else if (to == own) {
        controller_->Receive(received[from]->GetPointer(0), size, static_cast<int>(from), kTag);
      }
    }
  }
  Data theirs = mine;
  together([&] {
    for (std::size_t from = 0; from < count; ++from) {
      if (from != own) theirs[from] = vtkCommunicator::UnMarshalDataObject(received[from]);
    }
  });
  return theirs;
}
