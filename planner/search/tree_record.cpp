#include "downwash/search/tree_record.hpp"

#include <ompl/base/PlannerData.h>

#include <limits>

namespace downwash::planning {
namespace {

namespace ob = ompl::base;

constexpr int unseen = std::numeric_limits<int>::min();

/// The parent of every vertex on the way back to where its tree began; whichever way the planner's edges point.
class Parents {
 public:
    explicit Parents(const ob::PlannerData& data) : data_(data), parents_(data.numVertices(), unseen) {
        for (unsigned int i = 0; i < data.numStartVertices(); ++i) {
            follow(data.getStartIndex(i));
        }
        for (unsigned int i = 0; i < data.numGoalVertices(); ++i) {
            const unsigned int goal = data.getGoalIndex(i);
            // Planners list goals, too, from which no tree grows.
            if (std::vector<unsigned int> edges; data.getEdges(goal, edges) + data.getIncomingEdges(goal, edges) > 0) {
                follow(goal);
            }
        }
    }

    [[nodiscard]] int of(unsigned int vertex) const { return parents_[vertex]; }

 private:
    void follow(unsigned int root) {
        if (parents_[root] != unseen) {
            return;
        }
        parents_[root] = TreeNode::no_parent;
        std::vector<unsigned int> waiting{root}, neighbours;
        while (!waiting.empty()) {
            const unsigned int here = waiting.back();
            waiting.pop_back();
            data_.getEdges(here, neighbours);
            visit(neighbours, here, waiting);
            data_.getIncomingEdges(here, neighbours);
            visit(neighbours, here, waiting);
        }
    }

    void visit(const std::vector<unsigned int>& vertices, unsigned int from, std::vector<unsigned int>& waiting) {
        for (const unsigned int vertex : vertices) {
            if (parents_[vertex] == unseen) {
                parents_[vertex] = static_cast<int>(from);
                waiting.push_back(vertex);
            }
        }
    }

    const ob::PlannerData& data_;
    std::vector<int> parents_;
};

}  // namespace

template <class Configuration>
std::vector<BasicTreeNode<Configuration>> tree_of(const ob::Planner& planner,
                                                  const std::function<Configuration(const ob::State*)>& place) {
    ob::PlannerData data(planner.getSpaceInformation());
    planner.getPlannerData(data);
    const Parents parents(data);
    std::vector<int> index(data.numVertices(), TreeNode::no_parent);
    int count = 0;
    for (unsigned int i = 0; i < data.numVertices(); ++i) {
        index[i] = parents.of(i) == unseen ? TreeNode::no_parent : count++;
    }
    std::vector<BasicTreeNode<Configuration>> tree;
    tree.reserve(static_cast<std::size_t>(count));
    for (unsigned int i = 0; i < data.numVertices(); ++i) {
        if (const int parent = parents.of(i); parent != unseen) {
            const Configuration at = place(data.getVertex(i).getState());
            tree.push_back({at, parent < 0 ? TreeNode::no_parent : index[static_cast<std::size_t>(parent)]});
        }
    }
    return tree;
}

template std::vector<TreeNode> tree_of(const ob::Planner&, const std::function<Configuration(const ob::State*)>&);
template std::vector<SpaceTreeNode> tree_of(const ob::Planner&,
                                            const std::function<SpaceConfiguration(const ob::State*)>&);

}  // namespace downwash::planning
