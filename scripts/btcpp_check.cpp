// Loads an exported tree with BehaviorTree.CPP 4 and ticks it to its end with leaves that stand in for a robot's.
//
//   g++ -std=c++17 -O1 -I BTCPP/include -I BTCPP/3rdparty/tinyxml2 btcpp_check.cpp libbehaviortree_cpp.a -lpthread -ldl
//   ./a.out tree.xml CONDITIONS ACTIONS      CONDITIONS: yes, no or unknown; ACTIONS: succeed or fail
//
// The leaves and their ports are registered as the document's own TreeNodesModel describes them, with their types, so
// that the library checks every port of every node. Each leaf reads all its ports; one that is required and missing
// ends the check. Printed is a line for each leaf that is ticked (conditions left out), then how the tree ended.
#include <behaviortree_cpp/bt_factory.h>
#include <tinyxml2.h>

#include <cstring>
#include <iostream>
#include <map>
#include <set>

namespace
{
using Reading = std::map<std::string, double>;
constexpr int kPlaces = 2;        // places that each selector finds
constexpr int kMostTicks = 2000000;  // a tree that is ticked more often does not end

std::string conditions;
std::string actions;
std::set<std::string> robot_actions;  // leaves of which the argument ACTIONS says how they end
std::map<std::string, std::set<std::string>> required;

// Every port that stands at a node must be readable; every port without a default must stand there.
void readPorts(const BT::TreeNode& node)
{
  const auto& given = node.config().input_ports;
  for(const auto& name : required[node.registrationName()])
  {
    if(given.count(name) == 0 && node.config().output_ports.count(name) == 0)
    {
      throw BT::RuntimeError(node.registrationName(), " lacks the port ", name);
    }
  }
  for(const auto& [name, text] : given)
  {
    if(BT::TreeNode::isBlackboardPointer(text) && name != "reading" && !node.getInput<std::string>(name))
    {
      throw BT::RuntimeError(node.registrationName(), " cannot read the port ", name);
    }
  }
}

std::string textOf(const BT::TreeNode& node, const std::string& port)
{
  const auto found = node.getInput<std::string>(port);
  return found ? found.value() : std::string();
}

class Leaf : public BT::StatefulActionNode
{
public:
  using BT::StatefulActionNode::StatefulActionNode;

  BT::NodeStatus onStart() override
  {
    readPorts(*this);
    const auto& kind = registrationName();
    std::cout << kind;
    if(kind == "TakeExit")
    {
      std::cout << " " << textOf(*this, "then");
    }
    std::cout << "\n";
    if(kind == "ResolvePlaces")
    {
      auto queue = std::make_shared<std::deque<std::string>>();
      for(int k = 0; k < kPlaces; k++)
      {
        queue->push_back("place " + std::to_string(k));
      }
      setOutput("places", queue);
    }
    if(kind == "OrderSteps")
    {
      tinyxml2::XMLDocument places;
      if(places.Parse(("<all>" + textOf(*this, "places") + "</all>").c_str()) != tinyxml2::XML_SUCCESS)
      {
        throw BT::RuntimeError("the places of OrderSteps are not XML");
      }
      auto queue = std::make_shared<std::deque<int>>();
      int number = 0;
      for(auto e = places.RootElement()->FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
      {
        queue->push_front(++number);  // last step first
      }
      setOutput("order", queue);
    }
    return BT::NodeStatus::RUNNING;
  }

  BT::NodeStatus onRunning() override
  {
    const auto& kind = registrationName();
    if(kind == "HandleFault")
    {
      return BT::NodeStatus::FAILURE;
    }
    if(robot_actions.count(kind) == 0)
    {
      return BT::NodeStatus::SUCCESS;
    }
    if(config().output_ports.count("reading") != 0)
    {
      setOutput("reading", Reading{ { "measured", 1.0 } });
    }
    return actions == "fail" ? BT::NodeStatus::FAILURE : BT::NodeStatus::SUCCESS;
  }

  void onHalted() override {}
};

class Question : public BT::ConditionNode
{
public:
  using BT::ConditionNode::ConditionNode;

  BT::NodeStatus tick() override
  {
    readPorts(*this);
    bool answer = conditions == "yes";
    if(conditions == "unknown")
    {
      answer = registrationName() != "BudgetAllows" && getInput<bool>("if_unknown").value();
    }
    return answer ? BT::NodeStatus::SUCCESS : BT::NodeStatus::FAILURE;
  }
};

template <typename T>
BT::PortInfo typed(BT::PortDirection direction)
{
  return direction == BT::PortDirection::INPUT ? BT::InputPort<T>("any").second : BT::OutputPort<T>("any").second;
}

BT::PortInfo portOf(const tinyxml2::XMLElement* element)
{
  const bool input = std::strcmp(element->Name(), "input_port") == 0;
  const auto direction = input ? BT::PortDirection::INPUT : BT::PortDirection::OUTPUT;
  const std::string type = element->Attribute("type");
  BT::PortInfo info = typed<std::string>(direction);
  if(type == "int")
  {
    info = typed<int>(direction);
  }
  else if(type == "double")
  {
    info = typed<double>(direction);
  }
  else if(type == "bool")
  {
    info = typed<bool>(direction);
  }
  else if(type == "std::map<std::string, double>")
  {
    info = typed<Reading>(direction);
  }
  else if(type == "std::shared_ptr<std::deque<std::string>>")
  {
    info = typed<BT::SharedQueue<std::string>>(direction);
  }
  else if(type == "std::shared_ptr<std::deque<int>>")
  {
    info = typed<BT::SharedQueue<int>>(direction);
  }
  else if(type != "std::string")
  {
    throw BT::RuntimeError("the model names a type that is not known here: ", type);
  }
  const char* given = element->Attribute("default");
  if(given != nullptr && *given != '\0')
  {
    info.setDefaultValue(std::string(given));
  }
  return info;
}

void registerModels(BT::BehaviorTreeFactory& factory, const tinyxml2::XMLElement* models)
{
  const std::set<std::string> ours = { "BeginMission", "GoToPlace", "ResolvePlaces",
                                       "OrderSteps",   "TakeExit",  "HandleFault" };
  for(auto e = models->FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
  {
    const std::string kind = e->Name();
    const std::string id = e->Attribute("ID");
    BT::PortsList ports;
    for(auto p = e->FirstChildElement(); p != nullptr; p = p->NextSiblingElement())
    {
      const std::string name = p->Attribute("name");
      ports.insert({ name, portOf(p) });
      if(p->Attribute("default") == nullptr)
      {
        required[id].insert(name);
      }
    }
    if(kind == "Action")
    {
      if(ours.count(id) == 0)
      {
        robot_actions.insert(id);
      }
      factory.registerBuilder({ BT::NodeType::ACTION, id, ports, {} },
                              [](const std::string& name, const BT::NodeConfig& config) {
                                return std::make_unique<Leaf>(name, config);
                              });
    }
    else if(kind == "Condition")
    {
      factory.registerBuilder({ BT::NodeType::CONDITION, id, ports, {} },
                              [](const std::string& name, const BT::NodeConfig& config) {
                                return std::make_unique<Question>(name, config);
                              });
    }
    else
    {
      throw BT::RuntimeError("the model describes a ", kind, ", which is no leaf");
    }
  }
}
}  // namespace

int main(int argc, char** argv)
{
  if(argc != 4)
  {
    std::cerr << "usage: btcpp_check TREE.xml yes|no|unknown succeed|fail\n";
    return 2;
  }
  conditions = argv[2];
  actions = argv[3];
  try
  {
    tinyxml2::XMLDocument document;
    if(document.LoadFile(argv[1]) != tinyxml2::XML_SUCCESS)
    {
      throw BT::RuntimeError("not XML: ", document.ErrorStr());
    }
    BT::BehaviorTreeFactory factory;
    registerModels(factory, document.RootElement()->FirstChildElement("TreeNodesModel"));
    factory.registerBehaviorTreeFromFile(argv[1]);
    auto tree = factory.createTree(document.RootElement()->Attribute("main_tree_to_execute"));
    auto status = BT::NodeStatus::RUNNING;
    int ticks = 0;
    while(status == BT::NodeStatus::RUNNING)
    {
      if(++ticks > kMostTicks)
      {
        throw BT::RuntimeError("the tree does not end");
      }
      status = tree.tickExactlyOnce();
    }
    std::cout << "= " << BT::toStr(status) << "\n";
  }
  catch(const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
