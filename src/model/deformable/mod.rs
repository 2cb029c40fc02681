//! Robots that give way: rigid bodies whose robot may collide while the roadmap is built, as far as it can be deformed later.

mod settings;

pub use settings::{
    BoundingBoxSettings, ChainMailOrder, DeformationMethod, DeformationSettings, Feasibility,
    GeometricSettings, LatticeInterpolation,
};
