#include "edit/session/config_json.h"

#include "core/base/text.h"

namespace uw {

namespace {

Json scalar_json(const ConfigNode& node) {
    if (node.quoted) return node.scalar;
    if (node.scalar == "true") return true;
    if (node.scalar == "false") return false;
    double number = 0;
    if (parse_number(node.scalar, number) == NumberText::number) return number;
    return node.scalar;
}

}  // namespace

Json config_json(const ConfigNode& node) {
    switch (node.kind) {
        case ConfigNode::Kind::scalar:
            return scalar_json(node);
        case ConfigNode::Kind::sequence: {
            Json list = Json::array();
            for (const ConfigNode& item : node.items) list.push_back(config_json(item));
            return list;
        }
        case ConfigNode::Kind::map: {
            Json map = Json::object();
            for (const ConfigNode::Entry& entry : node.entries)
                map[entry.key] = config_json(entry.value);
            return map;
        }
        case ConfigNode::Kind::null:
            break;
    }
    return nullptr;
}

}  // namespace uw
