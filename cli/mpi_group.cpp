#include "cli/mpi_group.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "io/module.h"

namespace abbe::cli {
namespace {

// Open MPI's mpirun sets this variable in every process that it starts.
constexpr const char* kProcessCountVariable = "OMPI_COMM_WORLD_SIZE";

// The module if mpirun started several processes, else null.
const MpiModule* load_module() {
  const char* processes = std::getenv(kProcessCountVariable);
  if (processes == nullptr || std::string_view(processes) == "1") return nullptr;
  // Open MPI's own modules need the symbols of its library, which is therefore loaded with global scope.
  return &module_functions<MpiModule>(
      ABBE_MPI_MODULE, kMpiModuleSymbol, ModuleScope::shared,
      "mpirun: the MPI module, which lets processes render one film together,");
}

// Null until a command joins the other processes. A failure before that has none to end.
const MpiModule*& loaded_module() {
  static const MpiModule* module = nullptr;
  return module;
}

}  // namespace

const MpiGroup& mpi_group() {
  static const MpiGroup kSingleProcess;
  static const MpiModule* const kModule = loaded_module() = load_module();
  return kModule != nullptr ? kModule->mpi_group : kSingleProcess;
}

void abort_mpi_group(int code) {
  if (loaded_module() != nullptr) loaded_module()->abort(code);
}

RootOnlyOutput::RootOnlyOutput(const MpiGroup& mpi_group) {
  if (mpi_group.rank == 0) return;
  stream_ = ::dup(STDERR_FILENO);
  const int null_device = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (null_device < 0) return;
  (void)::dup2(null_device, STDERR_FILENO);
  (void)::close(null_device);
}

RootOnlyOutput::~RootOnlyOutput() {
  if (stream_ < 0) return;
  (void)::dup2(stream_, STDERR_FILENO);
  (void)::close(stream_);
}

}  // namespace abbe::cli
