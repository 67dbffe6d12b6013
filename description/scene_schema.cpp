#include "description/scene_schema.h"

#include "description/scene.h"
#include "io/schema/documentation.h"
#include "io/schema/write.h"

namespace abbe {

std::string scene_schema() {
  return to_lines(schema::json_schema(schema::fields_of<spec::Scene>()), kJsonWidth);
}

std::string scene_guide(const std::string& guide) {
  return schema::with_tables(guide, schema::fields_of<spec::Scene>());
}

}  // namespace abbe
