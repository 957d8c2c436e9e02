#include "downwash/results/tree_csv.hpp"

#include <cmath>
#include <vector>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

template <class Node>
std::string text_of(std::span<const Node> tree, std::span<const Axis> axes) {
    std::string text;
    for (const Axis& axis : axes) {
        text += std::string(axis.position) + ',';
    }
    text += "parent\n";
    for (const Node& node : tree) {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            text += to_text(node.at[i]) + ',';
        }
        text += node.parent == Node::no_parent ? "" : std::to_string(node.parent);
        text += '\n';
    }
    return text;
}

template <class Node>
NumberTable table_of(std::span<const Node> tree, std::span<const Axis> axes) {
    NumberTable table;
    for (const Axis& axis : axes) {
        table.names.emplace_back(axis.position);
    }
    table.names.emplace_back("parent");
    table.columns.resize(table.names.size());
    for (const Node& node : tree) {
        std::vector<double> row;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            row.push_back(node.at[i]);
        }
        row.push_back(node.parent == Node::no_parent ? NAN : static_cast<double>(node.parent));
        table.add_row(row);
    }
    return table;
}

}  // namespace

std::string tree_csv(std::span<const TreeNode> tree, std::span<const Axis> axes) {
    return text_of(tree, axes);
}

std::string tree_csv(std::span<const SpaceTreeNode> tree, std::span<const Axis> axes) {
    return text_of(tree, axes);
}

NumberTable tree_table(std::span<const TreeNode> tree, std::span<const Axis> axes) {
    return table_of(tree, axes);
}

NumberTable tree_table(std::span<const SpaceTreeNode> tree, std::span<const Axis> axes) {
    return table_of(tree, axes);
}

}  // namespace downwash
