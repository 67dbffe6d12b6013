// The module for MPI: all of Abbe's use of it, behind the functions of cli/crew.h.
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "cli/crew.h"
#include "io/error.h"

namespace abbe::cli {
namespace {

// At a time, so that neither the counts of MPI's calls nor its buffers grow with the film.
constexpr std::size_t kNumbersAtOnce = std::size_t{1} << 20;

void add(void* from, void* to, int* count, MPI_Datatype*) {
  const auto* numbers = static_cast<const Int128*>(from);
  auto* sums = static_cast<Int128*>(to);
  for (int i = 0; i < *count; ++i)
    if (!add_exactly(sums[i], numbers[i])) {  // MPI lets no exception through
      (void)std::fputs("abbe: film: the processes' samples add up to more than a film can hold\n", stderr);
      MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ErrorCode::scene));
    }
}

/// The type of the film's sums, and how to add them, which commutes and associates to the bit.
struct ExactSum {
  MPI_Datatype type = MPI_DATATYPE_NULL;
  MPI_Op op = MPI_OP_NULL;

  ExactSum() {
    MPI_Type_contiguous(sizeof(Int128), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(add, 1, &op);
  }
};

void collect(std::span<Int128> numbers, int rank) {
  static const ExactSum kSum;
  for (std::size_t first = 0; first < numbers.size(); first += kNumbersAtOnce) {
    const std::span<Int128> some = numbers.subspan(first, std::min(kNumbersAtOnce, numbers.size() - first));
    const auto count = static_cast<int>(some.size());
    if (rank == 0)
      MPI_Reduce(MPI_IN_PLACE, some.data(), count, kSum.type, kSum.op, 0, MPI_COMM_WORLD);
    else
      MPI_Reduce(some.data(), nullptr, count, kSum.type, kSum.op, 0, MPI_COMM_WORLD);
  }
  if (rank != 0) std::fill(numbers.begin(), numbers.end(), Int128{0});
}

std::uint64_t follow(std::uint64_t said) {
  MPI_Bcast(&said, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  return said;
}

CrewModule join() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  (void)std::atexit([] { MPI_Finalize(); });
  CrewModule module{{}, [](int code) { MPI_Abort(MPI_COMM_WORLD, code); }};
  MPI_Comm_rank(MPI_COMM_WORLD, &module.crew.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &module.crew.size);
  module.crew.collect = [rank = module.crew.rank](std::span<Int128> numbers) { collect(numbers, rank); };
  module.crew.follow = follow;
  return module;
}

}  // namespace
}  // namespace abbe::cli

extern "C" __attribute__((visibility("default"))) const abbe::cli::CrewModule* abbe_mpi() {
  static const abbe::cli::CrewModule kModule = abbe::cli::join();
  return &kModule;
}
