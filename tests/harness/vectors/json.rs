//! JSON that a person can read and `diff` shows well: one field a line, and one row a line in arrays of arrays.

use serde_json::Value;

/// The text of an object with these fields, in this order.
pub fn text(fields: &[(&str, Value)]) -> String {
    let fields: Vec<String> = fields.iter().map(|(name, value)| format!("  {}: {}", Value::from(*name), field(value))).collect();
    format!("{{\n{}\n}}\n", fields.join(",\n"))
}

fn field(value: &Value) -> String {
    let rows = |rows: Vec<String>| rows.join(",\n    ");
    match value {
        Value::Array(items) if items.iter().any(Value::is_array) => {
            format!("[\n    {}\n  ]", rows(items.iter().map(Value::to_string).collect()))
        }
        Value::Object(fields) if fields.values().any(Value::is_array) => {
            let named = |(name, value): (&String, &Value)| format!("{}: {value}", Value::from(name.as_str()));
            format!("{{\n    {}\n  }}", rows(fields.iter().map(named).collect()))
        }
        other => other.to_string(),
    }
}
