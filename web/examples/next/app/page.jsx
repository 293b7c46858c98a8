import { Walk } from "./Walk";

export default function Page() {
  return <main><Walk /></main>;
}
