//! The deepest that a linked image's stack can get, read from its machine code.
//!
//! A function's frame is the sum of all that its instructions take off the stack pointer; the image's stack is the largest sum of
//! frames along a way of calls. A call through a pointer is taken to reach every function whose address the image holds. Functions
//! that may call each other in a circle count once each: recursion deeper than that is missed, and so is the frame that an interrupt
//! pushes with what its handler takes (handlers are counted, from a stack of their own).

mod arm;
mod code;
mod riscv;
mod thumb;

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result};
use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};

pub use code::Effect;
use code::{Code, Function};

/// What is found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stack {
    /// Bytes.
    pub bytes: u32,
    /// The functions of that way, the outermost first, with their frames in bytes; those of a circle together.
    pub way: Vec<(String, u32)>,
    /// Calls through pointers in the image.
    pub indirect: usize,
    /// Functions in circles of calls.
    pub circular: usize,
}

/// Reads an ELF file.
pub fn worst(elf: &Path) -> Result<Stack> {
    let bytes = std::fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
    let code = Code::read(&bytes)?;
    let effects = code.functions.iter().map(|function| code.effects(function)).collect::<Result<Vec<_>>>()?;
    let mut taken = code.pointed.clone();
    taken.extend(effects.iter().flatten().filter_map(|effect| match effect {
        Effect::Takes(address) => code.starting(*address),
        _ => None,
    }));
    Ok(deepest(&code.functions, &graph(&code, &effects, &taken), indirect(&effects)))
}

fn indirect(effects: &[Vec<Effect>]) -> usize {
    effects.iter().flatten().filter(|effect| **effect == Effect::Indirect).count()
}

/// Frames, and who calls whom.
fn graph(code: &Code, effects: &[Vec<Effect>], taken: &BTreeSet<usize>) -> DiGraph<u32, ()> {
    let mut graph = DiGraph::new();
    let nodes: Vec<NodeIndex> = effects.iter().map(|effects| graph.add_node(frame(effects))).collect();
    for (caller, effects) in effects.iter().enumerate() {
        let mut callees = BTreeSet::new();
        for effect in effects {
            match effect {
                // Branches within a function are none of its calls, and one to itself counts once.
                Effect::Call(address) | Effect::Jump(address) => {
                    callees.extend(code.containing(*address).filter(|callee| *callee != caller));
                }
                Effect::Indirect => callees.extend(taken),
                Effect::Frame(_) | Effect::Takes(_) => {}
            }
        }
        for callee in callees {
            graph.add_edge(nodes[caller], nodes[callee], ());
        }
    }
    graph
}

fn frame(effects: &[Effect]) -> u32 {
    effects.iter().map(|effect| if let Effect::Frame(bytes) = effect { *bytes } else { 0 }).sum()
}

fn deepest(functions: &[Function], graph: &DiGraph<u32, ()>, indirect: usize) -> Stack {
    // Circles in the order in which their depths are known: callees first.
    let circles = tarjan_scc(graph);
    let mut circle_of = vec![0; graph.node_count()];
    let mut depths: Vec<(u32, Option<usize>)> = vec![];
    for (index, circle) in circles.iter().enumerate() {
        circle.iter().for_each(|node| circle_of[node.index()] = index);
        let own: u32 = circle.iter().map(|node| graph[*node]).sum();
        let callees = circle.iter().flat_map(|node| graph.neighbors(*node)).map(|callee| circle_of[callee.index()]);
        let next = callees.filter(|callee| *callee != index).max_by_key(|callee| depths[*callee].0);
        depths.push((own + next.map_or(0, |next| depths[next].0), next));
    }
    let top = (0..depths.len()).max_by_key(|circle| depths[*circle].0);
    let bytes = top.map_or(0, |top| depths[top].0);
    let way = std::iter::successors(top, |circle| depths[*circle].1).map(|circle| {
        let names: Vec<&str> = circles[circle].iter().map(|node| functions[node.index()].name.as_str()).collect();
        (names.join(" + "), circles[circle].iter().map(|node| graph[*node]).sum())
    });
    let circular = circles.iter().filter(|circle| circle.len() > 1).map(Vec::len).sum();
    Stack { bytes, way: way.collect(), indirect, circular }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn functions(count: usize) -> Vec<Function> {
        (0..count).map(|index| Function { name: format!("f{index}"), start: 0, end: 0 }).collect()
    }

    #[test]
    fn the_deepest_way_counts_and_a_circle_once() {
        let mut graph = DiGraph::new();
        let nodes: Vec<NodeIndex> = [10, 20, 5, 100, 7].into_iter().map(|frame| graph.add_node(frame)).collect();
        // 0 calls 1 and 2; 1 and 2 call each other; 2 calls 4; 3 is a handler that calls 4.
        for (caller, callee) in [(0, 1), (0, 2), (1, 2), (2, 1), (2, 4)] {
            graph.add_edge(nodes[caller], nodes[callee], ());
        }
        let without = deepest(&functions(5), &graph, 0);
        assert_eq!((without.bytes, without.circular, without.way.len()), (100, 2, 1));
        graph.add_edge(nodes[3], nodes[4], ());
        assert_eq!(deepest(&functions(5), &graph, 0).way, [("f3".to_owned(), 100), ("f4".to_owned(), 7)]);
        graph[nodes[0]] = 90;
        let stack = deepest(&functions(5), &graph, 3);
        assert_eq!((stack.bytes, stack.indirect), (90 + 25 + 7, 3));
        assert_eq!((stack.way.len(), stack.way[1].1), (3, 25));
    }
}
