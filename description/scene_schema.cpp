#include "description/scene_schema.h"

#include "description/scene.h"
#include "io/schema/json_schema.h"

namespace abbe {
namespace {

constexpr std::size_t kWidth = 140;

}  // namespace

std::string scene_schema() {
  return to_lines(schema::json_schema(schema::fields_of<spec::Scene>()), kWidth);
}

}  // namespace abbe
