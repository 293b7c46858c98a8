import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { Walk } from "./Walk";

createRoot(document.getElementById("root")!).render(<StrictMode><Walk /></StrictMode>);
