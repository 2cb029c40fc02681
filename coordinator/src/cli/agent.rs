use super::{seconds, share};
use clap::Args;

/// How an agent is started where nothing else is said.
const SSH: &str = "ssh -T -o BatchMode=yes {} roadmill agent";

/// Of everything that grows a roadmap: the machines that do the work, where it is not this one.
#[derive(Debug, Args)]
pub struct AgentsArguments {
    /// Work on these machines, each of which has an agent with workers of its own: names with commas between them, or
    /// @FILE with a name per line. --workers is then how many each has
    #[arg(long, value_name = "NAMES", conflicts_with = "threads")]
    pub agents: Option<String>,
    /// How an agent is started: a program and its arguments, {} stands for the machine's name; no shell reads it
    #[arg(long, value_name = "COMMAND", requires = "agents", default_value = SSH)]
    pub agent_command: String,
    /// How long a build goes on with no agent at work: seconds, or with a unit (90s, 10m, 2h)
    #[arg(long, value_name = "TIME", requires = "agents", value_parser = seconds, default_value = "10m")]
    pub agent_wait: f64,
    /// Have a share of all jobs done by two agents and compare; without it agents are trusted. What is to be compared
    /// waits until two are there
    #[arg(long, value_name = "PERCENT", requires = "agents", value_parser = share)]
    pub audit: Option<f64>,
}

/// Of `agent`.
#[derive(Debug, Args)]
pub struct AgentArguments {
    /// Worker processes, where the coordinator does not say how many [default: the cores this process may use]
    #[arg(long, value_name = "N")]
    pub workers: Option<usize>,
}
