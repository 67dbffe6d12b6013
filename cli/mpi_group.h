#pragma once

#include "transport/render/mpi_group.h"

namespace abbe::cli {

/// Functions of the MPI module, which is loaded under mpirun only.
struct MpiModule {
  MpiGroup mpi_group;
  void (*abort)(int code);  ///< Ends all processes with this exit code; does not return.
};
/// Name of the module's function that returns a `const MpiModule*`.
inline constexpr const char* kMpiModuleSymbol = "abbe_mpi";

/// The processes that mpirun started together with this one; this process alone without mpirun. The first
/// call loads the module, and waits until all processes have joined. Throws Error{input} if the module is
/// missing.
[[nodiscard]] const MpiGroup& mpi_group();

/// Ends all processes of the group with this exit code. A process that fails must call it, since the others
/// would wait for it indefinitely. Does nothing unless `mpi_group` has joined others.
void abort_mpi_group(int code);

/// Redirects standard error to /dev/null while it lives, in every process but the root (rank 0).
class RootOnlyOutput {
 public:
  explicit RootOnlyOutput(const MpiGroup& mpi_group);
  ~RootOnlyOutput();
  RootOnlyOutput(const RootOnlyOutput&) = delete;
  RootOnlyOutput& operator=(const RootOnlyOutput&) = delete;

 private:
  int stream_ = -1;  // duplicate of standard error, to restore it
};

}  // namespace abbe::cli
