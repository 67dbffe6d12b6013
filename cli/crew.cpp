#include "cli/crew.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "io/module.h"

namespace abbe::cli {
namespace {

// Set by Open MPI's mpirun for each process it starts.
constexpr const char* kProcesses = "OMPI_COMM_WORLD_SIZE";

const CrewModule* load_module() {
  const char* processes = std::getenv(kProcesses);
  if (processes == nullptr || std::string_view(processes) == "1") return nullptr;
  // Open MPI's own modules find its library among what is loaded for all.
  return &module_functions<CrewModule>(ABBE_MPI_MODULE, kCrewSymbol, ModuleScope::shared,
                                       "mpirun: the module by which processes render one film together");
}

// Nothing until a command has asked: what fails before has no others to end.
const CrewModule*& joined() {
  static const CrewModule* module = nullptr;
  return module;
}

}  // namespace

const Crew& crew() {
  static const Crew kAlone;
  static const CrewModule* const kModule = joined() = load_module();
  return kModule != nullptr ? kModule->crew : kAlone;
}

void abandon_crew(int code) {
  if (joined() != nullptr) joined()->abandon(code);
}

LeaderTells::LeaderTells(const Crew& crew) {
  if (crew.rank == 0) return;
  stream_ = ::dup(STDERR_FILENO);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  (void)::dup2(nowhere, STDERR_FILENO);
  (void)::close(nowhere);
}

LeaderTells::~LeaderTells() {
  if (stream_ < 0) return;
  (void)::dup2(stream_, STDERR_FILENO);
  (void)::close(stream_);
}

}  // namespace abbe::cli
