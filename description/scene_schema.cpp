#include "description/scene_schema.h"

#include "description/scene.h"
#include "io/schema/json_schema.h"

namespace abbe {

std::string scene_schema() {
  return to_lines(schema::json_schema(schema::fields_of<spec::Scene>()), kJsonWidth);
}

}  // namespace abbe
