use std::time::Instant;
fn main(){
 let root=std::path::PathBuf::from(std::env::args().nth(1).unwrap());
 let o=importer::Options::default();
 let (mut r,mut m,mut l,mut n,mut fail)=(0.0,0.0,0.0,0,0);
 let mut slow=vec![];
 for p in importer::discover(&root).unwrap(){
  let t=Instant::now(); let Ok(s)=importer::read(&p,&o) else {fail+=1;continue}; r+=t.elapsed().as_secs_f64();
  let t=Instant::now(); let w=importer::weld(&s.merged()); let x=importer::measure(&w); let d=t.elapsed().as_secs_f64(); m+=d;
  if d>0.15 {slow.push(format!("measure {:.2}s {} tris {}",d,p.display(),x.triangles));}
  let t=Instant::now(); if let Err(e)=importer::asset_of(&s,&o){println!("ERR {e}");} let d=t.elapsed().as_secs_f64(); l+=d; if d>4.0 {slow.push(format!("asset {:.1}s {}",d,p.display()));}
  n+=1;
 }
 println!("{n} read, {fail} refused; read {r:.2}s measure {m:.2}s asset_of {l:.2}s"); for s in slow{println!("{s}")}
}
