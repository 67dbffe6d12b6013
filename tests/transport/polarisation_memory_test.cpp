#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "transport/path/polarisation.h"

namespace abbe {
namespace {

TEST(Polarisation, MemoryThatIsGivenBackIsTakenAgain) {
  auto first = std::make_unique<Polarisation>();
  auto second = std::make_unique<Polarisation>();
  const Polarisation* last = second.get();
  first.reset();
  second.reset();
  second = std::make_unique<Polarisation>();
  EXPECT_EQ(second.get(), last);
  first = std::make_unique<Polarisation>();
  EXPECT_NE(first.get(), last);
}

// More objects than a thread's free list holds, created by one thread and destroyed by another.
TEST(Polarisation, ManyAreAlignedAndApart) {
  constexpr std::size_t kMany = 5000;
  std::vector<std::unique_ptr<Polarisation>> all;
  std::thread([&all] {
    for (std::size_t i = 0; i < kMany; ++i) all.push_back(std::make_unique<Polarisation>());
  }).join();
  const Polarisation vector({1, 0, 0}, StokesSpectrum{.i = SampledSpectrum(2.0F)});
  for (std::size_t i = 0; i < kMany; i += 2) *all[i] = vector;
  for (std::size_t i = 0; i < kMany; ++i) {
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(all[i].get()) % alignof(Polarisation), 0U);
    ASSERT_EQ(all[i]->of_unpolarised().i[0], i % 2 == 0 ? 2 : 1);
  }
}

}  // namespace
}  // namespace abbe
