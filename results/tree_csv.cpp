#include "downwash/results/tree_csv.hpp"

#include <cmath>
#include <vector>

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

NumberTable tree_table(std::span<const TreeNode> tree) {
    NumberTable table{{"x_m", "z_m", "arm_rad", "parent"}, std::vector<std::vector<double>>(4), {}};
    for (const TreeNode& node : tree) {
        const bool is_root = node.parent == TreeNode::no_parent;
        table.add_row({node.at.x_m, node.at.z_m, node.at.arm_rad, is_root ? NAN : static_cast<double>(node.parent)});
    }
    return table;
}

}  // namespace downwash
