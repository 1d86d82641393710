// Plays a film: shapes, actors and their poses, as written by replay.cpp. Works with every three.js from r109 on that
// defines a global THREE.
(function () {
  'use strict';

  const film = JSON.parse(document.getElementById('film').textContent);
  const element = (id) => document.getElementById(id);
  document.title = film.title + ' - InnerSphere';
  element('title').textContent = film.title;
  element('caption').textContent = film.caption;

  function decode(base64, type) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return new type(bytes.buffer);
  }

  // Colours are sRGB in the film and linear in the shaders.
  const managed = THREE.ColorManagement && THREE.ColorManagement.enabled;
  function colour(css) {
    const result = new THREE.Color(css);
    return managed ? result : result.convertSRGBToLinear();
  }

  // ---- Renderer, light and camera
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true});
  } catch (error) {
    element('failure').hidden = false;
    element('failure').textContent = 'This page needs WebGL, which this browser does not offer here.';
    return;
  }
  if (!('outputColorSpace' in renderer)) {
    if ('outputEncoding' in renderer) renderer.outputEncoding = THREE.sRGBEncoding;
    else renderer.gammaOutput = true;
  }
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  element('stage').appendChild(renderer.domElement);

  const scene = new THREE.Scene();
  const vector = (v) => new THREE.Vector3(v[0], v[1], v[2]);
  const eye = vector(film.camera.eye);
  const target = vector(film.camera.target);
  const reach = eye.distanceTo(target);
  const camera = new THREE.PerspectiveCamera(film.camera.field_of_view, 1, reach / 100, reach * 20);
  camera.up.set(0, 0, 1);
  camera.position.copy(eye);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.target.copy(target);
  controls.update();

  scene.add(new THREE.HemisphereLight(colour('#ffffff'), colour('#b9b4ac'), 0.75));
  const sun = new THREE.DirectionalLight(colour('#fff3e0'), 0.85);
  const forward = target.clone().sub(eye).setZ(0).normalize();
  const right = new THREE.Vector3(forward.y, -forward.x, 0);
  sun.position.copy(target).addScaledVector(forward, -0.55 * reach).addScaledVector(right, -0.75 * reach);
  sun.position.z += 1.15 * reach;
  sun.target.position.copy(target);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.bias = -0.0005;
  sun.shadow.radius = 3;
  const frustum = sun.shadow.camera;
  frustum.left = frustum.bottom = -0.6 * reach;
  frustum.right = frustum.top = 0.6 * reach;
  frustum.near = 0.1 * reach;
  frustum.far = 4 * reach;
  scene.add(sun, sun.target);

  if (film.ground !== null) {
    const floor = new THREE.Mesh(
        new (THREE.PlaneBufferGeometry || THREE.PlaneGeometry)(20 * reach, 20 * reach),
        new THREE.ShadowMaterial({opacity: 0.28}));
    floor.position.z = film.ground;
    floor.receiveShadow = true;
    scene.add(floor);
  }

  // ---- Shapes
  // Many small spheres need few triangles each, a few large ones need many.
  const kLargeSpheres = 48;
  const Icosahedron = THREE.IcosahedronBufferGeometry || THREE.IcosahedronGeometry;
  const Ball = THREE.SphereBufferGeometry || THREE.SphereGeometry;
  const fine = new Ball(1, 36, 24);
  const coarse = new Icosahedron(1, 2);

  // Every set of instances needs a geometry of its own: where the geometry stays the same from one draw call to the next,
  // old versions of three.js keep the instances, too.
  function sameGeometry(original) {
    const geometry = new THREE.BufferGeometry();
    geometry.index = original.index;
    geometry.attributes = original.attributes;
    return geometry;
  }

  function surfaceGeometry(shape) {
    const geometry = new THREE.BufferGeometry();
    const add = geometry.setAttribute ? 'setAttribute' : 'addAttribute';
    geometry[add]('position', new THREE.BufferAttribute(decode(shape.vertices, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(decode(shape.triangles, Uint32Array), 1));
    geometry.computeVertexNormals();
    return geometry;
  }

  // Spheres by the geometry that draws them and, if the film says so, by colour.
  function sphereBatches(shape) {
    const spheres = decode(shape.spheres, Float32Array);
    const ramp = shape.sphere_colours ? decode(shape.sphere_colours, Uint8Array) : null;
    const members = new Map();
    for (let i = 0; 4 * i < spheres.length; ++i) {
      const key = (i < kLargeSpheres ? 'fine ' : 'coarse ') + (ramp ? film.ramp[ramp[i]] : '');
      if (!members.has(key)) members.set(key, []);
      members.get(key).push(i);
    }
    return Array.from(members, ([key, indices]) => {
      const matrices = new Float32Array(16 * indices.length);
      indices.forEach((sphere, n) => {
        const [x, y, z, r] = spheres.subarray(4 * sphere, 4 * sphere + 4);
        matrices.set([r, 0, 0, 0, 0, r, 0, 0, 0, 0, r, 0, x, y, z, 1], 16 * n);
      });
      const [detail, tint] = key.split(' ');
      const Attribute = THREE.InstancedBufferAttribute;
      return {
        geometry: sameGeometry(detail === 'fine' ? fine : coarse),
        tint,
        count: indices.length,
        matrices: new Attribute(matrices, 16),
      };
    });
  }

  const shapes = film.shapes.map((shape) => ({
    surface: shape.triangles ? surfaceGeometry(shape) : null,
    batches: shape.spheres ? sphereBatches(shape) : [],
  }));

  // ---- Actors
  const materials = new Map();
  function material(css, through) {
    const key = css + through;
    if (!materials.has(key)) {
      materials.set(key, new THREE.MeshStandardMaterial({
        color: colour(css), roughness: 0.55, metalness: 0, side: THREE.DoubleSide, shadowSide: THREE.BackSide,
        transparent: through, opacity: through ? 0.3 : 1, depthWrite: !through,
      }));
    }
    return materials.get(key);
  }

  function withShadow(mesh) {
    mesh.castShadow = mesh.receiveShadow = true;
    return mesh;
  }

  const actors = film.actors.map((actor) => {
    const shape = shapes[actor.shape];
    const body = new THREE.Group();
    const result = {body, colour: actor.colour, surface: null, spheres: new THREE.Group()};
    if (shape.surface) {
      result.surface = withShadow(new THREE.Mesh(shape.surface, material(actor.colour, false)));
      body.add(result.surface);
    }
    for (const batch of shape.batches) {
      const mesh = new THREE.InstancedMesh(batch.geometry, material(batch.tint || actor.colour, false), batch.count);
      mesh.instanceMatrix = batch.matrices;  // shared by all actors of the shape
      mesh.frustumCulled = false;
      result.spheres.add(withShadow(mesh));
    }
    body.add(result.spheres);
    scene.add(body);
    return result;
  });

  let view = '';
  function setView(name) {
    view = name;
    for (const actor of actors) {
      const has_spheres = actor.spheres.children.length > 0;
      actor.spheres.visible = name !== 'surface' || !actor.surface;
      if (actor.surface) {
        const through = name === 'both' && has_spheres;
        actor.surface.visible = name !== 'spheres' || !has_spheres;
        actor.surface.material = material(actor.colour, through);
        actor.surface.castShadow = !through;
      }
    }
    for (const button of element('views').children) button.classList.toggle('on', button.dataset.view === name);
  }

  // ---- Time
  const poses = decode(film.poses, Float32Array);  // x y z, then the quaternion x y z w, of each actor in each frame
  const stride = 7 * actors.length;
  const frames = poses.length / stride;
  const duration = (frames - 1) / film.frame_rate;
  const from = new THREE.Quaternion();
  const to = new THREE.Quaternion();

  function setTime(time) {
    const exact = Math.min(Math.max(time * film.frame_rate, 0), frames - 1);
    const first = Math.min(Math.floor(exact), Math.max(frames - 2, 0));
    const t = exact - first;
    const next = Math.min(first + 1, frames - 1);
    actors.forEach((actor, n) => {
      const a = first * stride + 7 * n;
      const b = next * stride + 7 * n;
      const mix = (k) => poses[a + k] + t * (poses[b + k] - poses[a + k]);
      actor.body.position.set(mix(0), mix(1), mix(2));
      from.fromArray(poses, a + 3);
      to.fromArray(poses, b + 3);
      actor.body.quaternion.copy(from.slerp(to, t));
    });
    element('scrub').value = time;
    element('time').textContent = time.toFixed(2) + ' / ' + duration.toFixed(2) + ' s';
  }

  let time = 0;
  let playing = false;
  let last_tick = null;
  function setPlaying(on) {
    if (on && time >= duration) time = 0;
    playing = on;
    last_tick = null;
    element('play').textContent = on ? '\u275A\u275A' : '\u25B6';
  }

  // ---- Controls
  element('scrub').max = duration;
  element('scrub').addEventListener('input', (event) => { time = Number(event.target.value); setPlaying(false); });
  element('play').addEventListener('click', () => setPlaying(!playing));
  for (const button of element('views').children) {
    button.addEventListener('click', () => setView(button.dataset.view));
  }
  window.addEventListener('keydown', (event) => {
    if (event.target.tagName === 'SELECT') return;
    const views = {1: 'surface', 2: 'spheres', 3: 'both'};
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (event.key === ' ') setPlaying(!playing);
    else if (views[event.key]) setView(views[event.key]);
    else if (step) { time = Math.min(Math.max(time + step / film.frame_rate, 0), duration); setPlaying(false); }
    else return;
    event.preventDefault();
  });
  controls.enableKeys = false;  // the arrow keys step through the frames

  function resize() {
    const width = window.innerWidth;
    const height = window.innerHeight;
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    // A narrow window must not cut off the sides.
    const half = Math.tan(film.camera.field_of_view * Math.PI / 360) * Math.max(1, film.camera.aspect / camera.aspect);
    camera.fov = Math.atan(half) * 360 / Math.PI;
    camera.updateProjectionMatrix();
  }
  window.addEventListener('resize', resize);

  // A link can point at a moment and a view: #t=2.5&paused&view=spheres
  const link = new URLSearchParams(location.hash.slice(1));
  if (link.has('t')) time = Math.min(Math.max(Number(link.get('t')) || 0, 0), duration);
  const has_surface = shapes.some((shape) => shape.surface);
  setView(link.get('view') || (has_surface ? 'surface' : 'spheres'));
  element('views').hidden = !has_surface || !shapes.some((shape) => shape.batches.length);
  element('player').hidden = frames < 2;
  setPlaying(frames > 1 && !link.has('paused'));
  resize();

  function tick(now) {
    requestAnimationFrame(tick);
    if (playing && last_tick !== null) {
      time += Number(element('speed').value) * (now - last_tick) / 1000;
      if (time >= duration) { time = duration; setPlaying(false); }
    }
    last_tick = now;
    setTime(time);
    controls.update();
    renderer.render(scene, camera);
  }
  requestAnimationFrame(tick);
})();
