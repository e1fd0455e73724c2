#include "toolkit/cli/mpi_ranks.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <mpi.h>

#include "toolkit/mesh/errors.h"

namespace mimetra::cli {
namespace {

/// Largest number of values in a message, because MPI counts with int.
constexpr std::size_t kMost = std::size_t{1} << 27;

/// Calls `pass` with all numbers, in pieces that fit one message.
template <typename Number, typename Pass>
void in_pieces(std::span<Number> numbers, const Pass& pass) {
  for (std::size_t done = 0; done < numbers.size(); done += kMost) {
    const std::size_t count = std::min(kMost, numbers.size() - done);
    pass(numbers.data() + done, static_cast<int>(count));
  }
}

}  // namespace

MpiRanks::MpiRanks() {
  // Only this thread communicates.
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
}

MpiRanks::~MpiRanks() {
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Finalize();
}

void MpiRanks::send(int to, std::span<const double> numbers) const {
  in_pieces(numbers, [to](const double* data, int count) {
    MPI_Send(data, count, MPI_DOUBLE, to, 0, MPI_COMM_WORLD);
  });
}

void MpiRanks::receive(int from, std::span<double> numbers) const {
  in_pieces(numbers, [from](double* data, int count) {
    MPI_Recv(data, count, MPI_DOUBLE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  });
}

void MpiRanks::broadcast(int from, std::span<double> numbers) const {
  in_pieces(numbers, [from](double* data, int count) {
    MPI_Bcast(data, count, MPI_DOUBLE, from, MPI_COMM_WORLD);
  });
}

void MpiRanks::meet(const std::function<bool()>& goes_on) const {
  // A blocking barrier would not notice signals. The second round detects processes that died after
  // the first.
  for (int round = 0; round < 2; ++round) {
    MPI_Request all_are_here = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &all_are_here);
    for (int done = 0; !done;) {
      MPI_Test(&all_are_here, &done, MPI_STATUS_IGNORE);
      if (done) break;
      if (!goes_on()) throw Cancelled();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

int MpiRanks::on_this_machine() const {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int count = 1;
  MPI_Comm_size(machine, &count);
  MPI_Comm_free(&machine);
  return count;
}

void MpiRanks::end_all(int code) const {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

}  // namespace mimetra::cli
