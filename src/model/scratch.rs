use bincode::{Decode, Encode};
use std::any::Any;

/// What was asked of a model, counted where it is asked for: a measure of cost that is the same on every
/// machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Encode, Decode)]
pub struct Asked {
    /// Configurations whose validity was asked for.
    pub configurations: u64,
    /// Motions whose validity was asked for.
    pub motions: u64,
}

impl std::ops::AddAssign for Asked {
    fn add_assign(&mut self, other: Asked) {
        self.configurations += other.configurations;
        self.motions += other.motions;
    }
}

/// The working memory of a model: buffers that are kept from one question to the next.
pub trait ModelScratch: Any + Send {
    /// Fills the memory with rubbish that could mislead: for tests of the law that it never does.
    fn poison(&mut self, rubbish: u64);
}

/// Working memory of one thread: counters, and what the model in use keeps.
#[derive(Default)]
pub struct Scratch {
    asked: Asked,
    model: Option<Box<dyn ModelScratch>>,
}

impl Scratch {
    /// Fresh memory.
    pub fn new() -> Scratch {
        Scratch::default()
    }

    /// The counters since the last call.
    pub fn take_asked(&mut self) -> Asked {
        std::mem::take(&mut self.asked)
    }

    /// Does work whose questions are not counted.
    pub fn uncounted<T>(&mut self, work: impl FnOnce(&mut Scratch) -> T) -> T {
        let before = self.take_asked();
        let done = work(self);
        self.asked = before;
        done
    }

    /// Counts a question about a configuration that costs as much as one about its validity.
    pub fn count_configuration(&mut self) {
        self.asked.configurations += 1;
    }

    /// Counts a configuration whose validity is asked for, and gives the model its memory.
    pub fn for_configuration<M: ModelScratch + Default>(&mut self) -> &mut M {
        self.asked.configurations += 1;
        self.of_model()
    }

    /// Counts a motion whose validity is asked for, and gives the model its memory.
    pub fn for_motion<M: ModelScratch + Default>(&mut self) -> &mut M {
        self.asked.motions += 1;
        self.of_model()
    }

    /// The memory of a model. That of another model, which may have used this scratch before, is dropped.
    #[inline]
    pub fn of_model<M: ModelScratch + Default>(&mut self) -> &mut M {
        let is_ours = |model: &dyn ModelScratch| (model as &dyn Any).is::<M>();
        if !self.model.as_deref().is_some_and(is_ours) {
            self.model = Some(Box::<M>::default());
        }
        let model: &mut dyn Any = &mut **self.model.as_mut().expect("set above");
        model.downcast_mut().expect("it is of this type")
    }

    /// Fills the memory with rubbish that could mislead: for tests of the law that it never does.
    #[doc(hidden)]
    pub fn poison(&mut self, rubbish: u64) {
        if let Some(model) = &mut self.model {
            model.poison(rubbish);
        }
    }
}
