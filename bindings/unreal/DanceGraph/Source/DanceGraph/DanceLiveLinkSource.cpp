#include <DanceLiveLinkSource.h>
#include <HAL/PlatformProcess.h>
#include <ILiveLinkClient.h>
#include <Interfaces/IPluginManager.h>
#include <Misc/Paths.h>
#include <Roles/LiveLinkAnimationRole.h>
#include <Roles/LiveLinkAnimationTypes.h>

#include <cstring>

#define LOCTEXT_NAMESPACE "DanceGraph"

namespace {

// Often enough that no pose of a house at 120 Hz waits long; reading costs microseconds.
constexpr float kSecondsBetweenReads = 0.002f;

// The library in the plug-in's folder, wherever project or game were put; "" where it is not there
// and the system's is to be taken.
FString LibraryOfPlugin() {
  const TSharedPtr<IPlugin> Plugin = IPluginManager::Get().FindPlugin(TEXT("DanceGraph"));
  if (!Plugin) return FString();
  const FString Path = FPaths::ConvertRelativePathToFull(FPaths::Combine(
      Plugin->GetBaseDir(), TEXT("Source/DanceGraph/ThirdParty/libdance_adapter.so.1")));
  return FPaths::FileExists(Path) ? Path : FString();
}

}  // namespace

FDanceLiveLinkSource::FDanceLiveLinkSource(const FString& InHouseName)
    : HouseName(InHouseName),
      Library(TCHAR_TO_UTF8(*LibraryOfPlugin())),
      Adapter(Library, TCHAR_TO_UTF8(*InHouseName), DANCE_AXES_UNREAL),
      Pose(dancegraph::make<dance_pose>()),
      bIsStopping(false) {}

FDanceLiveLinkSource::~FDanceLiveLinkSource() { RequestSourceShutdown(); }

void FDanceLiveLinkSource::ReceiveClient(ILiveLinkClient* InClient, FGuid InSourceGuid) {
  Client = InClient;
  SourceGuid = InSourceGuid;
  if (Adapter) Thread = FRunnableThread::Create(this, TEXT("DanceGraph Live Link"));
}

bool FDanceLiveLinkSource::IsSourceStillValid() const { return static_cast<bool>(Adapter); }

bool FDanceLiveLinkSource::RequestSourceShutdown() {
  bIsStopping = true;
  if (Thread) {
    Thread->Kill(true);
    delete Thread;
    Thread = nullptr;
  }
  Client = nullptr;
  return true;
}

FText FDanceLiveLinkSource::GetSourceType() const { return LOCTEXT("Type", "DanceGraph"); }

FText FDanceLiveLinkSource::GetSourceMachineName() const {
  return FText::FromString(HouseName.IsEmpty() ? FString(TEXT("stage")) : HouseName);
}

FText FDanceLiveLinkSource::GetSourceStatus() const {
  if (!Library) return FText::FromString(FString(UTF8_TO_TCHAR(Library.problem())));
  if (!Adapter) return LOCTEXT("Name", "a name is 1 to 24 characters of a-z, 0-9 and '-'");
  return LOCTEXT("Reading", "reading");
}

void FDanceLiveLinkSource::Stop() { bIsStopping = true; }

uint32 FDanceLiveLinkSource::Run() {
  while (!bIsStopping) {
    PushDancers();
    FPlatformProcess::Sleep(kSecondsBetweenReads);
  }
  return 0;
}

void FDanceLiveLinkSource::PushDancers() {
  for (FDancer& Dancer : Dancers) Dancer.bIsHere = false;
  Adapter.guests(Guests);
  for (const dance_guest& Guest : Guests) {
    FDancer& Dancer = Dancers[Guest.slot];
    Dancer.bIsHere = Dancer.Generation == Guest.generation && std::strcmp(Dancer.Id, Guest.id) == 0;
  }
  // Before others are pushed: a guest who came back has another slot, but the same subject.
  for (FDancer& Dancer : Dancers)
    if (Dancer.bIsKnown && !Dancer.bIsHere) RemoveSubject(Dancer);
  for (const dance_guest& Guest : Guests)
    if (PushSkeleton(Dancers[Guest.slot], Guest)) PushPose(Dancers[Guest.slot], Guest);
}

// Names, parents and proportions; again whenever they are new.
bool FDanceLiveLinkSource::PushSkeleton(FDancer& Dancer, const dance_guest& Guest) {
  // Where the writer was faster, the dancer keeps what it had.
  dance_skeleton Skeleton = dancegraph::make<dance_skeleton>();
  if (Adapter.skeleton(Guest.slot, Skeleton) != DANCE_OK) return Dancer.bIsKnown;
  if (Dancer.bIsKnown && Dancer.Skeleton.version == Skeleton.version) return true;
  std::memcpy(Dancer.Id, Guest.id, sizeof(Dancer.Id));
  Dancer.Subject = FName(UTF8_TO_TCHAR(Guest.id));
  Dancer.Generation = Guest.generation;
  Dancer.Skeleton = Skeleton;
  FLiveLinkStaticDataStruct Static(FLiveLinkSkeletonStaticData::StaticStruct());
  FLiveLinkSkeletonStaticData& Data = *Static.Cast<FLiveLinkSkeletonStaticData>();
  for (uint32 Bone = 0; Bone < DANCE_BONES; ++Bone) {
    Data.BoneNames.Add(FName(UTF8_TO_TCHAR(Library.bone_name(Bone))));
    Data.BoneParents.Add(Library.bone_parent(Bone));
  }
  Client->PushSubjectStaticData_AnyThread({SourceGuid, Dancer.Subject},
                                          ULiveLinkAnimationRole::StaticClass(), MoveTemp(Static));
  Dancer.bIsKnown = true;
  Dancer.Sequence = 0;
  return true;
}

void FDanceLiveLinkSource::PushPose(FDancer& Dancer, const dance_guest& Guest) {
  if (Adapter.newest(Guest.slot, Pose) != DANCE_OK || Pose.sequence == Dancer.Sequence) return;
  Dancer.Sequence = Pose.sequence;
  FLiveLinkFrameDataStruct Frame(FLiveLinkAnimationFrameData::StaticStruct());
  FLiveLinkAnimationFrameData& Data = *Frame.Cast<FLiveLinkAnimationFrameData>();
  for (uint32 Bone = 0; Bone < DANCE_BONES; ++Bone) {
    const float* Q = Pose.rotation[Bone];
    const float* At = Bone == 0 ? Pose.hips_position : Dancer.Skeleton.offset[Bone];
    Data.Transforms.Add(FTransform(FQuat(Q[0], Q[1], Q[2], Q[3]), FVector(At[0], At[1], At[2])));
  }
  // Live Link evaluates by the engine's clock: how old the pose is now, taken from it.
  const double Age = static_cast<double>(Library.adapter_now_ns() - Pose.staged_ns) * 1e-9;
  Data.WorldTime = FLiveLinkWorldTime(FPlatformTime::Seconds() - Age);
  Client->PushSubjectFrameData_AnyThread({SourceGuid, Dancer.Subject}, MoveTemp(Frame));
}

void FDanceLiveLinkSource::RemoveSubject(FDancer& Dancer) {
  Client->RemoveSubject_AnyThread({SourceGuid, Dancer.Subject});
  Dancer = FDancer();
}

#undef LOCTEXT_NAMESPACE
