mod support;
#[test]
fn needles() {
    let root = support::models().unwrap();
    let source = importer::read(&root.join("hard/compressed/helicopter.gltf"), &importer::Options::default()).unwrap();
    let mesh = importer::weld(&source.merged()).mesh;
    let mut ratios: Vec<f64> = mesh.triangles.iter().map(|t| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let d = |p: [f64; 3], q: [f64; 3]| [p[0]-q[0], p[1]-q[1], p[2]-q[2]];
        let (u, v, w) = (d(b, a), d(c, a), d(c, b));
        let x = [u[1]*v[2]-u[2]*v[1], u[2]*v[0]-u[0]*v[2], u[0]*v[1]-u[1]*v[0]];
        let n = |p: [f64; 3]| p[0]*p[0]+p[1]*p[1]+p[2]*p[2];
        n(x).sqrt() / n(u).max(n(v)).max(n(w))
    }).collect();
    ratios.sort_by(f64::total_cmp);
    println!("{:?}", &ratios[..60]);
}
