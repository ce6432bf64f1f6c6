#pragma once

#include <string>

#include "paloc/tools/command.h"

namespace paloc {

/// A command that is nothing but a name for several others: `paloc bench smoother`.
class CommandGroup : public Command {
 public:
  CommandGroup(std::string name, std::string description,
               std::vector<std::unique_ptr<Command>> commands);

  void registerOn(CLI::App& app) override;
  bool called() const override { return find() != nullptr; }
  ExitCode run() override;

 private:
  Command* find() const;

  std::string name_, description_;
  std::vector<std::unique_ptr<Command>> commands_;
};

}  // namespace paloc
