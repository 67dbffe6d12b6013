#include "results/build_id.h"

#include <link.h>

#include <cstddef>
#include <cstring>
#include <string_view>

#include "io/text.h"

namespace abbe {
namespace {

// Rounds up to a multiple of four bytes.
std::size_t padded(std::size_t size) {
  return (size + 3) / 4 * 4;
}

// Description of the note "GNU" of type NT_GNU_BUILD_ID; empty if there is none.
std::string_view build_id_among(std::string_view notes) {
  constexpr std::string_view kOwner("GNU\0", 4);
  while (notes.size() > sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes.data(), sizeof(note));
    const std::size_t name = sizeof(note);
    const std::size_t description = name + padded(note.n_namesz);
    const std::size_t end = description + padded(note.n_descsz);
    if (end > notes.size()) break;
    if (note.n_type == NT_GNU_BUILD_ID && notes.substr(name, note.n_namesz) == kOwner)
      return notes.substr(description, note.n_descsz);
    notes.remove_prefix(end);
  }
  return {};
}

// True if this code is in the object: in the program itself, or in a module of another program.
bool is_ours(const dl_phdr_info& object) {
  const auto here = reinterpret_cast<ElfW(Addr)>(&padded);
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    const ElfW(Addr) begin = object.dlpi_addr + segment.p_vaddr;
    if (segment.p_type == PT_LOAD && here >= begin && here < begin + segment.p_memsz) return true;
  }
  return false;
}

// True if the object's code computes film values.
bool decides_bits(const dl_phdr_info& object) {
  const std::string_view path = object.dlpi_name;
  const std::string_view name = path.substr(path.rfind('/') + 1);
  return is_ours(object) || name.starts_with("libembree") || name.starts_with("libm.so");
}

// Callback of dl_iterate_phdr: appends the object's build id to the string `ids`.
int add_build_id(dl_phdr_info* object, std::size_t, void* ids) {
  if (!decides_bits(*object)) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE || segment.p_align > 4) continue;
    // The loader has mapped the notes to this address. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* notes = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
    *static_cast<std::string*>(ids) += build_id_among({notes, segment.p_memsz});
  }
  return 0;
}

}  // namespace

std::string build_id() {
  std::string ids;
  ::dl_iterate_phdr(add_build_id, &ids);
  return sha256(ids);
}

std::string instruction_set() {
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? "x86-64-v4" : "x86-64-v3";
}

}  // namespace abbe
