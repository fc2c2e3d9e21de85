/* The key to springs and belts: their colours, the greatest force, and how a slack belt is drawn. */
import { element, number } from "./format.js";

/** What `Inside.draw` says it drew, in the picture's legend; nothing where there is neither. */
export function tellInside({ springs, belts }) {
  const legend = document.querySelector(".legend");
  for (const old of legend.querySelectorAll(".inside")) old.remove();
  const units = [...new Set(springs.map((spring) => spring.unit))];
  for (const unit of units) {
    const most = Math.max(...springs.filter((spring) => spring.unit === unit).map((spring) => Math.abs(spring.force)));
    const key = element("span", "inside ramp", null, `spring, 0 to ${number(most)} ${unit}`);
    key.title = springs.map((spring) => `${spring.name} ${number(spring.force)} ${spring.unit}`).join(", ");
    legend.append(key);
  }
  if (!belts.length) return;
  const grip = element("span", "inside", null, "belt on the ground");
  grip.style.setProperty("--mark", "#56b4e9");
  grip.title = "Within 0.5 % of the wheel span of the ground. Belts are drawn as the model has them: the shortest way around their wheels, as if the ground did not press on them between wheels; it bears under the wheels only.";
  legend.append(grip);
  const loose = belts.filter((belt) => belt.slack > 5e-4).map((belt) => `${belt.name} is ${number(1000 * belt.slack)} mm slack`);
  if (loose.length) legend.append(element("span", "inside dim plain", null, `${loose.join(", ")}: drawn taut`));
}
