// The player as an anywidget: appended to the player's scripts.
function render({ model, el }) {
  const place = document.createElement("div");
  el.append(place);
  const view = model.get("data");
  let stop = () => {};
  flockanaPlayer(place, new Uint8Array(view.buffer, view.byteOffset, view.byteLength)).then((player) => {
    if (!player) return;
    stop = player.destroy;
    player.show(model.get("time"));
    model.on("change:time", () => player.show(model.get("time")));
    player.onpause = (time) => { model.set("time", time); model.save_changes(); };
  });
  return () => stop();
}
export default { render };
