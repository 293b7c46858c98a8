// Static files; a server renders the pages in the same way.
export default { output: "export" };
