#include "downwash/results/tree_csv.hpp"

#include "downwash/base/text.hpp"

namespace downwash {

std::string tree_csv(std::span<const TreeNode> tree) {
    std::string text = "x_m,z_m,arm_rad,parent\n";
    for (const TreeNode& node : tree) {
        text += to_text(node.at.x_m) + ',' + to_text(node.at.z_m) + ',' + to_text(node.at.arm_rad) + ',';
        text += node.parent == TreeNode::no_parent ? "" : std::to_string(node.parent);
        text += '\n';
    }
    return text;
}

}  // namespace downwash
