// All of Abbe's use of MPI, behind the functions of `MpiModule`.
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "cli/mpi_group.h"
#include "io/error.h"

namespace abbe::cli {
namespace {

// Numbers per call of MPI, so that neither its counts nor its buffers grow with the film.
constexpr std::size_t kMaxNumbersPerCall = std::size_t{1} << 20;

// Operation of MPI that adds 128-bit integers exactly.
void add(void* from, void* to, int* count, MPI_Datatype*) {
  const auto* numbers = static_cast<const Int128*>(from);
  auto* sums = static_cast<Int128*>(to);
  for (int i = 0; i < *count; ++i)
    if (!add_exactly(sums[i], numbers[i])) {  // MPI lets no exception through
      (void)std::fputs("abbe: film: the processes' samples add up to more than a film can hold\n", stderr);
      MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ErrorCode::scene));
    }
}

/// MPI type of the film's sums and operation that adds them. The addition commutes and associates to the bit.
struct ExactSum {
  MPI_Datatype type = MPI_DATATYPE_NULL;
  MPI_Op op = MPI_OP_NULL;

  ExactSum() {
    MPI_Type_contiguous(sizeof(Int128), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(add, 1, &op);
  }
};

void reduce_to_root(std::span<Int128> numbers, int rank) {
  static const ExactSum kSum;
  for (std::size_t first = 0; first < numbers.size(); first += kMaxNumbersPerCall) {
    const std::span<Int128> chunk =
        numbers.subspan(first, std::min(kMaxNumbersPerCall, numbers.size() - first));
    const auto count = static_cast<int>(chunk.size());
    if (rank == 0)
      MPI_Reduce(MPI_IN_PLACE, chunk.data(), count, kSum.type, kSum.op, 0, MPI_COMM_WORLD);
    else
      MPI_Reduce(chunk.data(), nullptr, count, kSum.type, kSum.op, 0, MPI_COMM_WORLD);
  }
  if (rank != 0) std::fill(numbers.begin(), numbers.end(), Int128{0});
}

std::uint64_t broadcast_from_root(std::uint64_t value) {
  MPI_Bcast(&value, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  return value;
}

// Initialises MPI for calls from the main thread, and finalises it at exit.
MpiModule start_mpi() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  (void)std::atexit([] { MPI_Finalize(); });
  MpiModule module{{}, [](int code) { MPI_Abort(MPI_COMM_WORLD, code); }};
  MPI_Comm_rank(MPI_COMM_WORLD, &module.mpi_group.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &module.mpi_group.size);
  module.mpi_group.reduce = [rank = module.mpi_group.rank](std::span<Int128> numbers) {
    reduce_to_root(numbers, rank);
  };
  module.mpi_group.broadcast = broadcast_from_root;
  return module;
}

}  // namespace
}  // namespace abbe::cli

extern "C" __attribute__((visibility("default"))) const abbe::cli::MpiModule* abbe_mpi() {
  static const abbe::cli::MpiModule kModule = abbe::cli::start_mpi();
  return &kModule;
}
