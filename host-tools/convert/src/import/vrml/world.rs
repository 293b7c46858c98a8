//! A world as its file has it: nodes with fields, names, prototypes, routes.

use std::collections::HashMap;

/// A field's value: whatever of these it holds.
#[derive(Clone, Debug, Default)]
pub struct Value {
    /// Numbers, one after the other.
    pub numbers: Vec<f64>,
    /// Nodes, those included that `USE` names.
    pub nodes: Vec<usize>,
    /// In a prototype's body, the field of its interface.
    pub is: Option<String>,
    /// Where it begins.
    pub line: usize,
}

/// A node.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its type, as it is written.
    pub kind: String,
    /// Its name.
    pub def: Option<String>,
    /// Where it begins.
    pub line: usize,
    /// Fields in the file's order.
    pub fields: Vec<(String, Value)>,
}

/// A prototype.
#[derive(Clone, Debug)]
pub struct Prototype {
    /// Its fields with what they are unless an instance says so.
    pub interface: Vec<(String, Value)>,
    /// The node that an instance is.
    pub first: usize,
}

/// From a node's event to another's. Nodes are known where a `DEF` stands before the route.
#[derive(Clone, Debug)]
pub struct Route {
    /// Node and its name.
    pub source: (Option<usize>, String),
    /// Node and its name.
    pub target: (Option<usize>, String),
    /// Event that comes in.
    pub event: String,
}

/// Everything.
#[derive(Debug, Default)]
pub struct World {
    /// All nodes.
    pub nodes: Vec<Node>,
    /// Nodes at the top.
    pub roots: Vec<usize>,
    /// Nodes by name; of several, the last.
    pub names: HashMap<String, usize>,
    /// Prototypes by name.
    pub prototypes: HashMap<String, Prototype>,
    /// Routes outside of prototypes.
    pub routes: Vec<Route>,
}

/// Prototypes of prototypes that are followed.
const DEEPEST: usize = 16;

impl World {
    /// The built-in type of a node: that of the first node in a prototype's body, and so on.
    pub fn kind(&self, node: usize) -> &str {
        let mut kind = &self.nodes[node].kind;
        for _ in 0..DEEPEST {
            match self.prototypes.get(kind) {
                // H-Anim's own prototypes say by their names what they are.
                Some(prototype) if !is_joint(kind) => kind = &self.nodes[prototype.first].kind,
                _ => break,
            }
        }
        kind
    }

    /// A field, by its name in the node's built-in type.
    pub fn field(&self, node: usize, name: &str) -> Option<&Value> {
        self.field_of(node, name, DEEPEST)
    }

    fn field_of(&self, node: usize, name: &str, left: usize) -> Option<&Value> {
        let entry = &self.nodes[node];
        let own = |name: &str| entry.fields.iter().rev().find(|(field, _)| field == name).map(|(_, value)| value);
        let Some(prototype) = self.prototypes.get(&entry.kind).filter(|_| left > 0) else { return own(name) };
        let inside = self.field_of(prototype.first, name, left - 1);
        match inside.map(|value| (value, &value.is)) {
            Some((_, Some(outside))) => {
                let default = || prototype.interface.iter().find(|(field, _)| field == outside).map(|(_, value)| value);
                own(outside).or_else(default)
            }
            Some((inside, None)) => own(name).or(Some(inside)),
            None => own(name),
        }
    }

    /// The field of the built-in type that an event of a node sets.
    pub fn set(&self, node: usize, event: &str) -> String {
        let event = event.strip_prefix("set_").unwrap_or(event);
        let event = event.strip_suffix("_changed").unwrap_or(event);
        let Some(prototype) = self.prototypes.get(&self.nodes[node].kind) else { return event.into() };
        let named = |(_, value): &&(String, Value)| value.is.as_deref() == Some(event);
        self.nodes[prototype.first].fields.iter().find(named).map_or_else(|| event.into(), |(field, _)| field.clone())
    }

    /// What a person would call a node.
    pub fn name(&self, node: usize) -> String {
        let entry = &self.nodes[node];
        let name = entry.def.as_deref().map(crate::import::one_line);
        name.unwrap_or_else(|| format!("{}:{}", crate::import::one_line(&entry.kind), entry.line))
    }
}

/// Whether this type is a joint of H-Anim.
pub fn is_joint(kind: &str) -> bool {
    matches!(kind, "Joint" | "HAnimJoint")
}

/// Whether this type has a place and a rotation.
pub fn is_transform(kind: &str) -> bool {
    is_joint(kind) || matches!(kind, "Transform" | "Humanoid" | "HAnimHumanoid" | "Site" | "HAnimSite")
}

/// Fields in which the nodes of a grouping node stand; `None` for other nodes.
pub fn children(kind: &str) -> &'static [&'static str] {
    match kind {
        "Humanoid" | "HAnimHumanoid" => &["humanoidBody", "skeleton", "children"],
        "Switch" => &["choice", "children"],
        "LOD" => &["level", "children"],
        "Joint" | "HAnimJoint" | "Transform" | "Site" | "HAnimSite" | "Segment" | "HAnimSegment" | "Group" | "StaticGroup"
        | "Anchor" | "Billboard" | "Collision" | "CADAssembly" => &["children"],
        _ => &[],
    }
}
